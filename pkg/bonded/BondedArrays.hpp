// GPL v2 or later, see LICENSE.
// Bonded spheres, their bonds and what has broken as numpy arrays.
#pragma once

#include <pkg/ddem/YadeInclude.hpp>

namespace yade {

class BondedSpheres;
class BrokenBond;

/// Ids of bodies from a sequence or an array of whole numbers. \throws std::invalid_argument for anything else
std::vector<Body::id_t> bodyIdsOf(const boost::python::object& ids);

/// Those of the ids whose bodies are there.
boost::python::object existingBodies(const Scene& scene, const boost::python::object& ids);

/** One quantity of some spheres, a row each, as of now.
 * \param spheres whose arrays are ahead of State; null: State holds all
 * \param name position, displacement, velocity, spin, rotation (three numbers) or radius
 * \throws std::invalid_argument for an unknown name, and for an id that is no sphere's */
boost::python::object sphereArray(
        const Scene& scene, const BondedSpheres* spheres, const boost::python::object& ids, const std::string& name);

/// A bond that holds.
struct BondNow {
	Body::id_t id1, id2;
	Real       normalStress, shearStress; ///< [Pa]
	Real       radius;                    ///< [m]
	Real       axialForce, shearForce;    ///< tension positive, and size [N]
};
/// Columns of bonds by name, in order of ids.
boost::python::dict bondArrays(std::vector<BondNow> bonds);

/// Columns of records by name, in their order.
boost::python::dict brokenArrays(const std::vector<shared_ptr<BrokenBond>>& records);

} // namespace yade
