// GPL v2 or later, see LICENSE.
#include <pkg/bonded/kernel/packing/SphereGrid.hpp>

#include <algorithm>
#include <cmath>

namespace yade::ddem {

namespace {
	// Cells of one octave at most: many more than there are spheres only cost memory.
	constexpr double mostCells = 1 << 24;

	double component(const SpaceVector<double>& a, int axis) { return axis == 0 ? a.x : axis == 1 ? a.y : a.z; }
}

SphereGrid::SphereGrid(
        int                        dimension,
        const SpaceVector<double>& lowerCorner,
        const SpaceVector<double>& upper,
        double                     smallest,
        double                     largestRadius)
        : lower(lowerCorner)
        , largest(largestRadius)
{
	const SpaceVector<double> size   = upper - lower;
	double                    volume = 1;
	for (int axis = 0; axis < dimension; axis++)
		volume *= component(size, axis);
	for (double radius = largest; octaves.empty() || radius >= smallest; radius *= 0.5) {
		Octave       octave { radius, 0, { 1, 1, 1 }, {}, {} };
		const double width = std::max(2 * radius, std::pow(volume / mostCells, 1. / dimension));
		octave.perMetre    = 1 / width;
		for (int axis = 0; axis < dimension; axis++)
			octave.cells[std::size_t(axis)]
			        = std::max(std::int64_t(1), std::int64_t(std::ceil(component(size, axis) / width)));
		octave.first.assign(std::size_t(octave.cells[0] * octave.cells[1] * octave.cells[2]), -1);
		octaves.push_back(std::move(octave));
	}
}

SphereGrid::CellRange SphereGrid::range(const Octave& octave, int axis, double centre, double reach) const
{
	const std::int64_t last = octave.cells[std::size_t(axis)] - 1;
	const double       at   = centre - component(lower, axis);
	const auto         cell = [&](double x) {
                return std::int64_t(std::clamp(x * octave.perMetre, 0., double(last)));
	};
	return { cell(at - reach), cell(at + reach) };
}

// Calls look(member) for all whose centres are closer than *reach* along each axis, until it returns true.
template <class Visit>
bool SphereGrid::visit(const Octave& octave, const SpaceVector<double>& point, double reach, const Visit& look) const
{
	const CellRange x = range(octave, 0, point.x, reach), y = range(octave, 1, point.y, reach),
	                z = range(octave, 2, point.z, reach);
	for (std::int64_t k = z.from; k <= z.to; k++)
		for (std::int64_t j = y.from; j <= y.to; j++) {
			const std::int64_t row = (k * octave.cells[1] + j) * octave.cells[0];
			for (std::int64_t i = x.from; i <= x.to; i++)
				for (std::int32_t m = octave.first[std::size_t(row + i)]; m >= 0;) {
					const Member& member = octave.members[std::size_t(m)];
					if (look(member)) return true;
					m = member.next;
				}
		}
	return false;
}

void SphereGrid::add(const PackedSphere& sphere)
{
	std::size_t place = 0;
	while (place + 1 < octaves.size() && sphere.radius <= octaves[place + 1].largest)
		place++;
	Octave&            octave = octaves[place];
	const std::int64_t x = range(octave, 0, sphere.centre.x, 0).from, y = range(octave, 1, sphere.centre.y, 0).from,
	                   z     = range(octave, 2, sphere.centre.z, 0).from;
	std::int32_t&      first = octave.first[std::size_t((z * octave.cells[1] + y) * octave.cells[0] + x)];
	octave.members.push_back({ sphere, std::int32_t(all.size()), first });
	first = std::int32_t(octave.members.size()) - 1;
	all.push_back(sphere);
}

void SphereGrid::offerAround(const SpaceVector<double>& point, double reach, ClosestThings& closest) const
{
	for (const Octave& octave : octaves) {
		if (octave.members.empty()) continue;
		visit(octave, point, std::min(reach, closest.limit()) + octave.largest, [&](const Member& member) {
			closest.offer(norm(point - member.sphere.centre) - member.sphere.radius, member.number);
			return false;
		});
	}
}

bool SphereGrid::overlaps(const PackedSphere& sphere, double tolerance) const
{
	for (const Octave& octave : octaves) {
		if (octave.members.empty()) continue;
		const bool hit
		        = visit(octave, sphere.centre, sphere.radius + octave.largest, [&](const Member& member) {
			          const SpaceVector<double> way = sphere.centre - member.sphere.centre;
			          const double apart = sphere.radius + member.sphere.radius - tolerance;
			          return dot(way, way) < apart * apart;
		          });
		if (hit) return true;
	}
	return false;
}

} // namespace yade::ddem
