// GPL v2 or later, see LICENSE.
// Pressure of a flexible membrane on particles beneath it.
#pragma once

#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <vector>

namespace yade::ddem {

/** A triangulated surface whose nodes move with particles: each with the weighted mean of those that carry it.
 *
 * A pressure p pushes each face by p times its present area, against its normal, a third of that at each of its nodes,
 * which hand it on by the same weights. On a closed surface these forces are the exact gradient -∂(pV)/∂x of the volume
 * within; at the nodes they have no resultant and no moment, and what they do is -p dV, however far it deforms.
 */
class Membrane {
public:
	using Face   = std::array<std::int32_t, 3>;
	using Vector = Eigen::Vector3d;

	/// A node that a particle carries, by its share.
	struct Support {
		std::int32_t node, particle;
		double       weight; ///< [-]; those of a node add up to 1
	};

	/** \param faces nodes of each face under pressure, so that the normal of the right hand points out
	 * \param ends faces that close the surface and are kept from the pressure, as by platens
	 * \param supports in any order, particles counted from 0
	 * \param offsets from the weighted mean of the particles' centres to each node [m]; keep their direction in
	 * space
	 * \throws std::invalid_argument saying which number is out of range */
	Membrane(const std::vector<Face>& faces, const std::vector<Face>& ends, const std::vector<Support>& supports,
	         const std::vector<Vector>& offsets);
	Membrane() = default;

	/** Forces on the particles [N], the same bit by bit for any number of threads.
	 * \param centres of the particles [m] \param pressure that presses inwards [Pa] */
	void forces(const std::vector<Vector>& centres, double pressure, std::vector<Vector>& result);

	/** Takes the moment about an axis away from forces, by the smallest change of them (in least squares):
	 * a rotation field about the mean of the places, which has no resultant.
	 *
	 * A fluid cannot twist what stands between two flat ends. But forces that act at centres, beside the nodes,
	 * could; and as offsets do not turn with the sample, a small rotation would grow. With it forces are the
	 * gradient of p V for offsets that turn with the mean rotation about the axis. \param axis unit vector */
	static void takeMoment(const std::vector<Vector>& places, const Vector& axis, std::vector<Vector>& forces);

	/// Volume within faces and ends [m³].
	double volume(const std::vector<Vector>& centres) const;

	/// Area of the faces under pressure [m²].
	double area(const std::vector<Vector>& centres) const;

	/** Share of the area of the faces that has turned its outside in [-].
	 * \param normals of the faces as they were made, of any length */
	double turned(const std::vector<Vector>& centres, const std::vector<Vector>& normals) const;

	/// Present places of the nodes [m].
	std::vector<Vector> nodes(const std::vector<Vector>& centres) const;

	std::size_t particles() const { return nodesOf.count(); }

private:
	/// Lists of different lengths, one after the other.
	template <class Item> struct Lists {
		std::vector<std::size_t> begins; ///< and the end of the last
		std::vector<Item>        items;
		std::size_t count() const { return begins.empty() ? 0 : begins.size() - 1; }
	};
	struct Share {
		std::int32_t of;
		double       weight;
	};
	template <class Item, class Each> static Lists<Item> listed(std::size_t count, const Each& each);
	Vector node(const std::vector<Vector>& centres, std::size_t i) const;
	void   checkNodes(const std::vector<Face>& of, const char* what) const;
	void   checkWeights() const;

	std::vector<Face>   faces, ends;
	std::vector<Vector> offsets;
	Lists<Share>        particlesOf; ///< by node
	Lists<Share>        nodesOf;     ///< by particle
	Lists<std::int32_t> facesOf;     ///< by node
	std::vector<Vector> places, areas, pushes; ///< of nodes, of faces, on nodes in the present step
};

} // namespace yade::ddem
