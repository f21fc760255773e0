// GPL v2 or later, see LICENSE.
// Kinematics and forces of triangles as plain pointers, and the batch that fills up the end of a group.
#pragma once

#include <pkg/ddem/kernel/algebra/Lanes.hpp>
#include <pkg/ddem/kernel/triangles/ElementFrame.hpp>
#include <pkg/ddem/kernel/triangles/Tiles.hpp>

#include <algorithm>
#include <cstdint>

namespace yade::ddem {

/// What an element loop reads and writes; rows are triangles.
struct ElementArrays {
	const std::int32_t* vertex[3];
	const double*       arm[4]; ///< r_1x, r_1y, r_2x, r_2y [m]
	const double*       nodePosition;
	const double*       corePosition;
	const double*       coreAngle;      ///< null unless cores rotate
	double*             cornerForce[3]; ///< x, y of corner e of every triangle [N]
	double*             coreForce;
	double*             coreMoment; ///< null unless cores rotate
};

/// What the triangles of a group share.
struct GroupConstants {
	double thickness       = 1; ///< [m]
	double rotationModulus = 0; ///< μ β_φ [Pa]
};

/// An element (or a batch of them) as the loops see it.
template <class Number> struct LoadedElement {
	TriangleReference<Number>     reference;
	PlaneVector<Number>           centre; ///< position of the core [m]
	RelativeDisplacements<Number> fromCentre;
	PlaneRotation<Number>         frame;
	RelativeDisplacements<Number> du;
};

template <class Frame, class Number> inline LoadedElement<Number> loadElement(const ElementArrays& a, std::size_t i)
{
	using L = Lanes<Number>;
	LoadedElement<Number>     element;
	const PlaneVector<Number> first { L::load(a.arm[0] + i), L::load(a.arm[1] + i) };
	const PlaneVector<Number> second { L::load(a.arm[2] + i), L::load(a.arm[3] + i) };
	element.reference = TriangleReference<Number>(first, second);
	element.centre    = L::loadPoints(a.corePosition + 2 * i);
	for (int e = 0; e < 3; e++)
		element.fromCentre[e] = L::gatherPoints(a.nodePosition, a.vertex[e] + i) - element.centre;
	Number angle(0);
	if constexpr (Frame::coreRotates) angle = L::load(a.coreAngle + i);
	element.frame = Frame::rotation(element.reference, element.fromCentre, angle);
	for (int e = 0; e < 3; e++)
		element.du[e] = relativeDisplacement(element.frame, element.fromCentre[e], element.reference.arm[e]);
	return element;
}

template <class Frame, class Number>
inline void storeForces(
        const ElementArrays&                 a,
        std::size_t                          i,
        const LoadedElement<Number>&         element,
        const RelativeDisplacements<Number>& q)
{
	using L = Lanes<Number>;
	const ElementForces<Number> force
	        = Frame::distribute(element.reference, element.fromCentre, element.frame, element.du, q);
	for (int e = 0; e < 3; e++)
		L::storePoints(a.cornerForce[e] + 2 * i, force.vertex[e]);
	L::storePoints(a.coreForce + 2 * i, force.core);
	if constexpr (Frame::coreRotates) L::store(a.coreMoment + i, force.moment);
}

/** The last triangles of a group, fewer than a batch, filled up with copies of the last one. They go through the
 * instructions of every other batch, so that a triangle's forces have the same bits at any place. */
class FilledBatch {
public:
	/// \param count rows from `first` on that are real, at least 1 and at most widestBatch.
	FilledBatch(const ElementArrays& all, std::size_t first, std::size_t count, bool rotates)
	        : from(all)
	        , row(first)
	        , real(count)
	        , spins(rotates)
	{
		for (std::size_t lane = 0; lane < widestBatch; lane++) {
			const std::size_t i = first + std::min(lane, count - 1);
			for (std::size_t e = 0; e < 3; e++)
				vertex[e][lane] = all.vertex[e][i];
			for (std::size_t c = 0; c < 4; c++)
				arm[c][lane] = all.arm[c][i];
			corePosition[2 * lane]     = all.corePosition[2 * i];
			corePosition[2 * lane + 1] = all.corePosition[2 * i + 1];
			coreAngle[lane]            = spins ? all.coreAngle[i] : 0;
		}
	}
	ElementArrays arrays()
	{
		return { { vertex[0], vertex[1], vertex[2] },
			 { arm[0], arm[1], arm[2], arm[3] },
			 from.nodePosition,
			 corePosition,
			 coreAngle,
			 { cornerForce[0], cornerForce[1], cornerForce[2] },
			 coreForce,
			 coreMoment };
	}
	/// Copies the forces of the real ones to where they belong.
	void handOver() const
	{
		for (std::size_t e = 0; e < 3; e++)
			std::copy_n(cornerForce[e], 2 * real, from.cornerForce[e] + 2 * row);
		std::copy_n(coreForce, 2 * real, from.coreForce + 2 * row);
		if (spins) std::copy_n(coreMoment, real, from.coreMoment + row);
	}

private:
	const ElementArrays& from;
	std::size_t          row, real;
	bool                 spins;
	std::int32_t         vertex[3][widestBatch];
	double               arm[4][widestBatch], corePosition[2 * widestBatch], coreAngle[widestBatch];
	double               cornerForce[3][2 * widestBatch], coreForce[2 * widestBatch], coreMoment[widestBatch];
};

} // namespace yade::ddem
