// GPL v2 or later, see LICENSE.
// Walls that repel bonded particles elastically: material, physics and the functors between them.
#include <pkg/bonded/ElasticWall.hpp>
#include <pkg/ddem/kernel/BondWall.hpp>

#include <sstream>

namespace yade {

DDEM_PLUGIN((ElasticWallMat)(ElasticWallPhys)(Ip2_ElasticWallMat_BondedMat_ElasticWallPhys)(Law2_ScGeom_ElasticWallPhys_Repulsion))

void ElasticWallMat::validate() const
{
	if (stiffness > 0 && std::isfinite(stiffness)) return;
	std::ostringstream text;
	text << "ElasticWallMat" << (label.empty() ? "" : " '" + label + "'") << ": stiffness = " << stiffness << " Pa must be positive and finite";
	throw std::invalid_argument(text.str());
}

void Ip2_ElasticWallMat_BondedMat_ElasticWallPhys::go(const shared_ptr<Material>& wall, const shared_ptr<Material>&, const shared_ptr<Interaction>& interaction)
{
	if (interaction->phys) return;
	auto phys           = boost::make_shared<ElasticWallPhys>();
	phys->wallStiffness = static_cast<const ElasticWallMat&>(*wall).stiffness;
	phys->kn            = ddem::wallSpring(static_cast<const ScGeom&>(*interaction->geom).radius2, phys->wallStiffness);
	interaction->phys   = phys;
}

bool Law2_ScGeom_ElasticWallPhys_Repulsion::go(shared_ptr<IGeom>& iGeom, shared_ptr<IPhys>& iPhys, Interaction* I)
{
	// The wall is always the first body of a wall-sphere geometry, and the normal points from it to the sphere's side.
	const auto& geom     = static_cast<const ScGeom&>(*iGeom);
	auto&       phys     = static_cast<ElasticWallPhys&>(*iPhys);
	const Real  distance = geom.normal.dot(Body::byId(I->getId2(), scene)->state->pos - Body::byId(I->getId1(), scene)->state->pos);
	const Real  force    = ddem::wallRepulsion(geom.radius2, phys.wallStiffness, distance);
	phys.normalForce     = force * geom.normal;
	if (!(force > 0)) return false;
	scene->forces.addForce(I->getId1(), -phys.normalForce);
	scene->forces.addForce(I->getId2(), phys.normalForce);
	if (scene->trackEnergy) energy.add(*scene->energy, BondedEnergy::WallElastic, 0.5 * force * (geom.radius2 - distance));
	return true;
}

} // namespace yade
