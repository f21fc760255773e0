// GPL v2 or later, see LICENSE.
// From two materials to a contact or a bond.
#include <pkg/bonded/Ip2_BondedMat_BondedMat_BondedPhys.hpp>
#include <pkg/bonded/BondedInteractionLoop.hpp>
#include <pkg/ddem/SingleProcess.hpp>

#include <sstream>

namespace yade {

DDEM_PLUGIN((Ip2_BondedMat_BondedMat_BondedPhys)(Ip2_FrictMat_BondedMat_BondedPhys))

namespace {

	/// Forces on a grid's connection belong to its nodes, which this law does not know.
	void refuseGrid(Scene& scene, const Interaction& I)
	{
		if (I.geom->getClassName() != "ScGridCoGeom") return;
		stopAfterStep(
		        scene,
		        "bodies #" + std::to_string(I.getId1()) + " and #" + std::to_string(I.getId2())
		                + ": BondedMat has no contact with grid connections and PFacets; give these bodies "
		                  "another mask, or use Facet");
	}

	struct Particle {
		Body*            body;
		const Sphere*    sphere;
		const BondedMat* material;
	};

	[[noreturn]] void refuse(const Vector2i& pair, const std::string& why)
	{
		std::ostringstream text;
		text << "cannot bond bodies #" << pair[0] << " and #" << pair[1] << ": " << why;
		throw std::invalid_argument(text.str());
	}

	Particle checkedParticle(const Scene& scene, const Vector2i& pair, int id)
	{
		const std::string name = "#" + std::to_string(id);
		if (id < 0 || id >= int(scene.bodies->size()) || !(*scene.bodies)[id])
			refuse(pair, "there is no body " + name);
		Body*          body = (*scene.bodies)[id].get();
		const Particle particle { body, dynamic_cast<const Sphere*>(body->shape.get()),
			                  dynamic_cast<const BondedMat*>(body->material.get()) };
		if (!particle.sphere) refuse(pair, name + " is not a sphere");
		if (!particle.material) refuse(pair, name + " has no BondedMat");
		particle.material->validate();
		if (!(particle.sphere->radius > 0) || !std::isfinite(particle.sphere->radius))
			refuse(pair,
			       "radius of " + name + " = " + std::to_string(particle.sphere->radius)
			               + " m must be positive and finite");
		if (!body->state->pos.allFinite()) refuse(pair, "position of " + name + " is not finite");
		return particle;
	}

	bool isBonded(const shared_ptr<Interaction>& interaction)
	{
		const auto* phys = interaction ? dynamic_cast<const BondedPhys*>(interaction->phys.get()) : nullptr;
		return phys && phys->bonded;
	}

	/// Geometry of the pair, as Ig2_Sphere_Sphere_ScGeom or …6D would have made it and will update it.
	shared_ptr<ScGeom6D> makeGeometry(
	        const Particle& a, const Particle& b, const Scene& scene, const shared_ptr<Interaction>& interaction)
	{
		const Vector3r branch   = b.body->state->pos - a.body->state->pos;
		const Real     distance = branch.norm();
		auto           geom     = boost::make_shared<ScGeom6D>();
		geom->radius1           = a.sphere->radius;
		geom->radius2           = b.sphere->radius;
		geom->penetrationDepth  = geom->radius1 + geom->radius2 - distance;
		geom->contactPoint
		        = a.body->state->pos + (geom->radius1 - geom->penetrationDepth / 2) / distance * branch;
		geom->precompute(
		        *a.body->state, *b.body->state, &scene, interaction, branch / distance, true, Vector3r::Zero());
		geom->initRotations(*a.body->state, *b.body->state);
		return geom;
	}

} // namespace

void Ip2_BondedMat_BondedMat_BondedPhys::go(
        const shared_ptr<Material>& material1, const shared_ptr<Material>& material2,
        const shared_ptr<Interaction>& interaction)
{
	if (interaction->phys) return;
	refuseGrid(*scene, *interaction);
	interaction->phys = BondedPhys::contact(
	        static_cast<const BondedMat&>(*material1), static_cast<const BondedMat&>(*material2),
	        BondedPhys::reachOf(*interaction));
}

void Ip2_FrictMat_BondedMat_BondedPhys::go(
        const shared_ptr<Material>& material1, const shared_ptr<Material>& material2,
        const shared_ptr<Interaction>& interaction)
{
	if (interaction->phys) return;
	refuseGrid(*scene, *interaction);
	const auto* bonded = dynamic_cast<const BondedMat*>(material1.get()); // they come in either order
	const auto& other  = static_cast<const FrictMat&>(bonded ? *material2 : *material1);
	if (!bonded) bonded = static_cast<const BondedMat*>(material2.get());
	BondedMat like       = *bonded;
	like.young           = other.young;
	like.frictionStatic  = math::tan(other.frictionAngle);
	like.frictionDynamic = like.frictionStatic;
	interaction->phys    = BondedPhys::contact(like, *bonded, BondedPhys::reachOf(*interaction));
}

void Ip2_BondedMat_BondedMat_BondedPhys::bond(const std::vector<Vector2i>& pairs)
{
	Scene& current = *Omega::instance().getScene();
	requireSingleProcess(current);
	if (current.isPeriodic)
		throw std::invalid_argument(
		        "bonds across periodic boundaries are not supported: set O.periodic = False");
	std::set<std::pair<int, int>> seen;
	for (const Vector2i& pair : pairs) { // all checks come first, so that nothing is half-built on error
		if (pair[0] == pair[1]) refuse(pair, "a body cannot be bonded to itself");
		const Particle a = checkedParticle(current, pair, pair[0]), b = checkedParticle(current, pair, pair[1]);
		if (!((b.body->state->pos - a.body->state->pos).norm() > 0)) refuse(pair, "they have the same centre");
		const shared_ptr<Interaction> old = current.interactions->find(pair[0], pair[1]);
		if (!seen.insert(std::minmax(pair[0], pair[1])).second || isBonded(old))
			refuse(pair, "they are bonded already");
	}
	for (const Vector2i& pair : pairs) {
		const auto [first, second] = std::minmax(pair[0], pair[1]);
		const Particle a = checkedParticle(current, pair, first), b = checkedParticle(current, pair, second);
		if (const auto old = current.interactions->find(first, second))
			current.interactions->erase(first, second, old->linIx);
		auto interaction  = boost::make_shared<Interaction>(first, second);
		auto phys         = BondedPhys::contact(*a.material, *b.material, a.sphere->radius + b.sphere->radius);
		interaction->geom = makeGeometry(a, b, current, interaction);
		interaction->phys = phys;
		phys->join(*a.body->state, *b.body->state, b.body->state->pos - a.body->state->pos);
		interaction->iterMadeReal = current.iter;
		current.interactions->insert(interaction);
	}
}

} // namespace yade
