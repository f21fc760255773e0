// GPL v2 or later, see LICENSE.
#include <pkg/ddem/EdgeEngine.hpp>

#include <pkg/ddem/DeformableEngine.hpp>

#include <atomic>
#include <set>

namespace yade {

DDEM_PLUGIN((EdgeEngine))

void EdgeEngine::postLoad(EdgeEngine&)
{
	std::set<std::pair<int, int>> known;
	for (const Vector2i& edge : edges)
		if (!known.emplace(edge.minCoeff(), edge.maxCoeff()).second)
			throw std::invalid_argument(
			        getClassName() + ".edges: the edge between nodes " + std::to_string(edge[0]) + " and "
			        + std::to_string(edge[1])
			        + " is given twice, and would be loaded twice; give each edge once");
	static std::atomic<unsigned long> given { 0 };
	counter = ++given;
}

void EdgeEngine::action()
{
	if (DeformableEngine::in(*scene).empty())
		throw std::runtime_error(
		        getClassName()
		        + " acts through a DeformableEngine, and O.engines has none: add DeformableEngine()");
}

} // namespace yade
