// GPL v2 or later, see LICENSE.
// Pairs of spheres that are close to each other, and which of them touch.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace yade::ddem {

/** Pairs that may come to touch. They are looked at in groups; a group whose closest pair is apart by a gap need not be
 * looked at again before the fastest sphere can have come half of that far, so that a sample at rest costs nothing.
 */
class SpherePairs {
public:
	void clear();
	/// \param reach distance of the centres below which they touch [m]
	void add(std::int32_t first, std::int32_t second, double reach);
	std::size_t size() const { return first.size(); }

	/// Lets a pair out of the search, as one that touches and is followed by others, or takes it in again.
	void follow(std::size_t pair, bool followed);

	/** Finds pairs that touch and are not followed.
	 * \param pose rows of spheres, see SphereMotion
	 * \param moved how far any sphere may have moved since the last call at most [m]; infinity: not known
	 * \param touching gets their places, ascending */
	void find(const double* pose, double moved, std::vector<std::int32_t>& touching);

	std::int32_t firstOf(std::size_t pair) const { return first[pair]; }
	std::int32_t secondOf(std::size_t pair) const { return second[pair]; }
	double       reachOf(std::size_t pair) const { return reach[pair]; }

private:
	double look(const double* pose, std::size_t group, bool& found) const;

	std::vector<std::int32_t> first, second;
	std::vector<double>       reach;
	std::vector<char>         followed;
	double                    way = 0;  ///< that any sphere may have gone
	std::vector<double>       next;     ///< of every group: the way at which it must be looked at again
};

} // namespace yade::ddem
