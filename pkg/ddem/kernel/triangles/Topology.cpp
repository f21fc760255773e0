// GPL v2 or later, see LICENSE.
#include <pkg/ddem/kernel/triangles/Topology.hpp>

#include <limits>
#include <stdexcept>

namespace yade::ddem {

void Topology::addTriangle(const std::array<std::int32_t, 3>& nodes, const TriangleReference<double>& ref)
{
	for (std::size_t e = 0; e < 3; e++)
		vertex[e].push_back(nodes[e]);
	for (std::size_t e = 0; e < 2; e++) {
		arm[2 * e].push_back(ref.arm[e].x);
		arm[2 * e + 1].push_back(ref.arm[e].y);
	}
}

void Topology::connect(std::size_t nodes)
{
	const std::size_t n = triangles();
	for (const auto& list : vertex)
		if (list.size() != n) throw std::logic_error("Topology: three corners per triangle");
	for (const auto& list : arm)
		if (list.size() != n) throw std::logic_error("Topology: two arms per triangle");
	if (3 * n > std::numeric_limits<CornerIndex>::max())
		throw std::logic_error("Topology: too many triangles for 32-bit corner indices");
	cornerStart.assign(nodes + 1, 0);
	for (const auto& list : vertex)
		for (const std::int32_t v : list) {
			if (v < 0 || std::size_t(v) >= nodes)
				throw std::logic_error("Topology: node index out of range");
			cornerStart[std::size_t(v) + 1]++;
		}
	for (std::size_t v = 0; v < nodes; v++)
		cornerStart[v + 1] += cornerStart[v];
	corner.assign(3 * n, 0);
	std::vector<std::size_t> next(cornerStart.begin(), cornerStart.end() - 1);
	for (std::size_t i = 0; i < n; i++)
		for (std::size_t e = 0; e < 3; e++)
			corner[next[std::size_t(vertex[e][i])]++] = cornerIndex(i, e);
}

} // namespace yade::ddem
