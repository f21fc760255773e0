// GPL v2 or later, see LICENSE.
// Walls that repel or hold bonded particles elastically: material, physics and the functors between them.
#include <pkg/bonded/BondedInteractionLoop.hpp>
#include <pkg/bonded/ElasticWall.hpp>
#include <pkg/bonded/kernel/BondWall.hpp>
#include <pkg/ddem/kernel/algebra/EigenSpace.hpp>

#include <sstream>

namespace yade {

DDEM_PLUGIN((ElasticWallMat)
        (ElasticWallPhys)
        (Ip2_ElasticWallMat_BondedMat_ElasticWallPhys)
        (Law2_ScGeom_ElasticWallPhys_Repulsion))

void ElasticWallMat::validate() const
{
	const auto refuse = [this](const char* name, Real value, const char* complaint) {
		std::ostringstream text;
		text << "ElasticWallMat" << (label.empty() ? "" : " '" + label + "'") << ": " << name << " = " << value
		     << " Pa " << complaint;
		throw std::invalid_argument(text.str());
	};
	if (!(stiffness > 0) || !std::isfinite(stiffness))
		refuse("stiffness", stiffness, "must be positive and finite");
	if (!(shearStiffness >= 0) || !std::isfinite(shearStiffness))
		refuse("shearStiffness", shearStiffness, "must not be negative");
}

namespace {

	shared_ptr<ElasticWallPhys> makeWallContact(const ElasticWallMat& material, Real radius)
	{
		auto phys            = boost::make_shared<ElasticWallPhys>();
		phys->wallStiffness  = material.stiffness;
		phys->shearStiffness = material.shearStiffness;
		phys->kn             = ddem::wallSpring(radius, material.stiffness);
		return phys;
	}

	/// A sphere that a wall has left behind altogether is no contact: walls have met, or a sphere was too fast.
	void stopBehindWall(Scene& scene, const Interaction& I, const char* what, Real depth)
	{
		std::ostringstream text;
		text << "sphere #" << I.getId2() << " is " << depth << " m behind the " << what << " #" << I.getId1()
		     << " in step " << scene.iter << ", t = " << scene.time
		     << " s, more than its radius: the platens have met, or it came too fast for the time step; "
		        "end the run earlier, or load slower";
		stopAfterStep(scene, text.str());
	}

	[[noreturn]] void refuseWall(int wall, const std::string& why)
	{
		throw std::invalid_argument("cannot bond spheres to the wall #" + std::to_string(wall) + ": " + why);
	}

} // namespace

void Ip2_ElasticWallMat_BondedMat_ElasticWallPhys::go(
        const shared_ptr<Material>& wall, const shared_ptr<Material>&, const shared_ptr<Interaction>& interaction)
{
	if (interaction->phys) return;
	interaction->phys = makeWallContact(
	        static_cast<const ElasticWallMat&>(*wall), static_cast<const ScGeom&>(*interaction->geom).radius2);
}

void Ip2_ElasticWallMat_BondedMat_ElasticWallPhys::bond(int wall, const std::vector<int>& spheres)
{
	Scene&     current  = *Omega::instance().getScene();
	const auto bodyOf = [&](int id) {
		return id >= 0 && id < int(current.bodies->size()) ? (*current.bodies)[id].get() : nullptr;
	};
	const Body* const wallBody = bodyOf(wall);
	const auto*       shape    = wallBody ? dynamic_cast<const Wall*>(wallBody->shape.get()) : nullptr;
	const auto*       material = wallBody ? dynamic_cast<const ElasticWallMat*>(wallBody->material.get()) : nullptr;
	if (!shape || !material) refuseWall(wall, "it is no Wall of ElasticWallMat");
	material->validate();
	for (const int id : spheres) { // all checks come first, so that nothing is half-built on error
		const Body* body = bodyOf(id);
		if (!body || !dynamic_cast<const Sphere*>(body->shape.get())
		    || !dynamic_cast<const BondedMat*>(body->material.get()))
			refuseWall(wall, "body #" + std::to_string(id) + " is no sphere of BondedMat");
		const auto old  = current.interactions->find(wall, id);
		const auto phys = old ? dynamic_cast<const ElasticWallPhys*>(old->phys.get()) : nullptr;
		if ((phys && phys->bonded) || std::count(spheres.begin(), spheres.end(), id) > 1)
			refuseWall(wall, "sphere #" + std::to_string(id) + " is bonded to it already");
	}
	for (const int id : spheres) {
		if (const auto old = current.interactions->find(wall, id))
			current.interactions->erase(wall, id, old->linIx);
		const Body&    body = *bodyOf(id);
		const Vector3r branch = body.state->pos - wallBody->state->pos;
		auto           geom   = boost::make_shared<ScGeom>();
		geom->radius1 = geom->radius2 = static_cast<const Sphere&>(*body.shape).radius;
		geom->normal                  = Vector3r::Unit(shape->axis)
		        * (shape->sense ? shape->sense : (branch[shape->axis] < 0 ? -1 : 1));
		geom->penetrationDepth        = geom->radius2 - geom->normal.dot(branch);
		geom->contactPoint            = body.state->pos - geom->normal * geom->normal.dot(branch);
		auto phys                     = makeWallContact(*material, geom->radius2);
		phys->bonded                  = true;
		phys->ks                      = ddem::wallSpring(geom->radius2, material->shearStiffness);
		phys->bondedBranch            = branch;
		// in the order of the functors, which must not be swapped later
		auto interaction              = boost::make_shared<Interaction>(wall, id);
		interaction->geom             = geom;
		interaction->phys             = phys;
		interaction->iterMadeReal     = current.iter;
		current.interactions->insert(interaction);
	}
}

bool Law2_ScGeom_ElasticWallPhys_Repulsion::go(shared_ptr<IGeom>& iGeom, shared_ptr<IPhys>& iPhys, Interaction* I)
{
	// What is no sphere is always the first body of a geometry with one,
	// and the normal points from it to the sphere.
	const auto&    geom   = static_cast<const ScGeom&>(*iGeom);
	auto&          phys   = static_cast<ElasticWallPhys&>(*iPhys);
	const Body&    wall   = *Body::byId(I->getId1(), scene);
	const bool     isWall = wall.shape->getClassIndex() == Wall::getClassIndexStatic();
	const Vector3r branch = Body::byId(I->getId2(), scene)->state->pos - wall.state->pos;
	Real           stored = 0;
	if (phys.bonded) {
		const Vector3r displacement = branch - phys.bondedBranch;
		const Vector3r force = ddem::eigenVector(ddem::bondedWallForce(
		        geom.radius2, phys.wallStiffness, phys.shearStiffness, ddem::spaceVector(displacement),
		        ddem::spaceVector(geom.normal)));
		phys.normalForce            = force.dot(geom.normal) * geom.normal;
		phys.shearForce             = force - phys.normalForce;
		stored                      = -0.5 * force.dot(displacement);
	} else {
		// Behind a wall the distance is negative; a box or a facet has no behind.
		const Real distance = isWall ? geom.normal.dot(branch) : geom.radius2 - geom.penetrationDepth,
		           force    = ddem::wallRepulsion(geom.radius2, phys.wallStiffness, distance);
		phys.normalForce = force * geom.normal;
		if (!(force > 0)) return false;
		if (distance < -geom.radius2) stopBehindWall(*scene, *I, isWall ? "wall" : "platen", -distance);
		stored = 0.5 * force * (geom.radius2 - distance);
	}
	const Vector3r force = phys.normalForce + phys.shearForce;
	scene->forces.addForce(I->getId1(), -force);
	scene->forces.addForce(I->getId2(), force);
	if (!isWall) // which does not turn
		scene->forces.addTorque(I->getId1(), (geom.contactPoint - wall.state->pos).cross(-force));
	if (scene->trackEnergy) energy.add(*scene->energy, BondedEnergy::WallElastic, stored);
	return true;
}

} // namespace yade
