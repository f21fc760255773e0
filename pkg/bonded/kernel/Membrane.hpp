// GPL v2 or later, see LICENSE.
// Pressure of a flexible membrane on particles beneath it.
#pragma once

#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <vector>

namespace yade::ddem {

/** A triangulated surface whose nodes move with particles: each node keeps its place beside the centre of one.
 *
 * A pressure p pushes each face by p times its present area, against its normal, a third of that at each of its nodes.
 * On a closed surface these forces are the exact gradient -∂(pV)/∂x of the volume within; they have no resultant and no
 * moment, and what they do is -p dV, however far it deforms.
 */
class Membrane {
public:
	using Face   = std::array<std::int32_t, 3>;
	using Vector = Eigen::Vector3d;

	/** \param faces nodes of each face under pressure, so that the normal of the right hand points out
	 * \param ends faces that close the surface and are kept from the pressure, as by platens
	 * \param carriers particle of each node, counted from 0
	 * \param offsets from the centre of that particle to the node [m], which keeps its direction in space
	 * \throws std::invalid_argument saying which number is out of range */
	Membrane(std::vector<Face> faces, std::vector<Face> ends, std::vector<std::int32_t> carriers,
	         std::vector<Vector> offsets);
	Membrane() = default;

	/** Forces on the particles [N], the same bit by bit for any number of threads.
	 * \param centres of the particles [m] \param pressure that presses inwards [Pa] */
	void forces(const std::vector<Vector>& centres, double pressure, std::vector<Vector>& result);

	/// Volume within faces and ends [m³].
	double volume(const std::vector<Vector>& centres) const;

	/// Area of the faces under pressure [m²].
	double area(const std::vector<Vector>& centres) const;

	/** Share of the area of the faces that has turned its outside in [-].
	 * \param normals of the faces as they were made, of any length */
	double turned(const std::vector<Vector>& centres, const std::vector<Vector>& normals) const;

	std::size_t particles() const { return begins.empty() ? 0 : begins.size() - 1; }

private:
	Vector node(const std::vector<Vector>& centres, std::int32_t i) const
	{
		return centres[std::size_t(carriers[std::size_t(i)])] + offsets[std::size_t(i)];
	}
	/// Area vector of a face [m²].
	Vector areaOf(const std::vector<Vector>& centres, const Face& face) const;
	void checkNodes(const std::vector<Face>& of, const char* what) const;

	std::vector<Face>         faces, ends;
	std::vector<std::int32_t> carriers;
	std::vector<Vector>       offsets;
	std::vector<std::size_t>  begins;  ///< by particle, of its part of the list of corners
	std::vector<std::int32_t> corners; ///< faces, once for each corner that a particle carries
	std::vector<Vector>       areas;   ///< by face, of the present step
};

} // namespace yade::ddem
