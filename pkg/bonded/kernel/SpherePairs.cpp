// GPL v2 or later, see LICENSE.
#include <pkg/bonded/kernel/SphereMotion.hpp>
#include <pkg/bonded/kernel/SpherePairs.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace yade::ddem {

namespace {

	constexpr std::size_t perGroup = 64;

	constexpr double infinity = std::numeric_limits<double>::infinity();

} // namespace

void SpherePairs::clear() { *this = SpherePairs(); }

void SpherePairs::add(std::int32_t firstSphere, std::int32_t secondSphere, double distance)
{
	first.push_back(firstSphere);
	second.push_back(secondSphere);
	reach.push_back(distance);
	followed.push_back(0);
	next.resize((size() + perGroup - 1) / perGroup);
	next.back() = -infinity;
}

void SpherePairs::follow(std::size_t pair, bool by)
{
	followed[pair]        = by;
	next[pair / perGroup] = -infinity;
}

double SpherePairs::look(const double* pose, std::size_t group, bool& found) const
{
	double            smallest = infinity;
	const std::size_t end      = std::min((group + 1) * perGroup, size());
	for (std::size_t k = group * perGroup; k < end; k++) {
		const double *a = pose + sphereRow * first[k], *b = pose + sphereRow * second[k];
		const double  x = b[0] - a[0], y = b[1] - a[1], z = b[2] - a[2];
		const double  gap = followed[k] ? infinity : std::sqrt(x * x + y * y + z * z) - reach[k];
		smallest          = gap < smallest ? gap : smallest;
	}
	found = smallest < 0;
	return smallest;
}

void SpherePairs::find(const double* pose, double moved, std::vector<std::int32_t>& touching)
{
	touching.clear();
	way += moved;
	if (!(way < infinity)) { // they have moved in an unknown way
		way = 0;
		std::fill(next.begin(), next.end(), -infinity);
	}
	const auto        groups = std::ptrdiff_t(next.size());
	std::vector<char> found(std::size_t(groups), 0);
	bool              any = false;
#pragma omp parallel for schedule(static) reduction(|| : any) if (groups > 200)
	for (std::ptrdiff_t g = 0; g < groups; g++) {
		const auto group = std::size_t(g);
		if (way < next[group]) continue;
		bool here   = false;
		next[group] = way + 0.5 * look(pose, group, here);
		found[group] = here;
		any          = any || here;
	}
	if (!any) return;
	for (std::size_t group = 0; group < next.size(); group++) {
		if (!found[group]) continue;
		const std::size_t end = std::min((group + 1) * perGroup, size());
		for (std::size_t k = group * perGroup; k < end; k++) {
			const double *a = pose + sphereRow * first[k], *b = pose + sphereRow * second[k];
			const double  x = b[0] - a[0], y = b[1] - a[1], z = b[2] - a[2];
			if (!followed[k] && std::sqrt(x * x + y * y + z * z) < reach[k])
				touching.push_back(std::int32_t(k));
		}
	}
}

} // namespace yade::ddem
