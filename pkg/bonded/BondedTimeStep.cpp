// GPL v2 or later, see LICENSE.
// What limits the time step in a scene of bonded spheres, and a guard that watches it.
#include <pkg/bonded/BondedTimeStep.hpp>

#include <pkg/bonded/BondedPhys.hpp>
#include <pkg/bonded/ElasticWall.hpp>
#include <pkg/bonded/RoundPlaten.hpp>
#include <pkg/bonded/kernel/BondStableStep.hpp>
#include <pkg/bonded/kernel/BondWall.hpp>

#include <core/TimeStepper.hpp>
#include <pkg/common/Box.hpp>

#include <optional>
#include <sstream>

namespace yade {

namespace {

	constexpr long lookInterval    = 1000; ///< steps between looks
	constexpr long contactInterval = 100;  ///< where contacts have formed

	bool moves(const Body& mover) { return mover.state->blockedDOFs != State::DOF_ALL && mover.state->mass > 0; }

	/// A spring between what moves two bodies, whose places are not known yet.
	struct Connection {
		ddem::PairSpring spring, damper;
		Body::id_t       mover1, mover2;
	};

	/// From the centre of what moves a body to the contact [m].
	/// \param radius where that is the body itself, a sphere \param central becomes false where it is not
	Real armOf(const Body& body, const Body& mover, Real radius, const Vector3r& contactPoint, bool& central)
	{
		if ((&body == &mover && isSphere(body)) || !moves(mover)) return radius;
		central = false;
		return (contactPoint - mover.state->pos).norm();
	}

	std::optional<Connection> connectionOf(const Scene& scene, const Interaction& I)
	{
		const auto* geom = dynamic_cast<const ScGeom*>(I.geom.get());
		const auto* phys = dynamic_cast<const NormShearPhys*>(I.phys.get());
		if (!geom || !phys) return std::nullopt;
		const Body &body1 = *(*scene.bodies)[I.getId1()], &body2 = *(*scene.bodies)[I.getId2()];
		const Body &mover1 = moverOf(scene, I.getId1()), &mover2 = moverOf(scene, I.getId2());
		if (&mover1 == &mover2) return std::nullopt; // members of one clump
		const auto* bond = dynamic_cast<const BondedPhys*>(phys);
		// elastic walls act at the centres of spheres
		Real       radius1 = geom->radius1, radius2 = geom->radius2;
		const bool atCentre = dynamic_cast<const ElasticWallPhys*>(phys);
		if (atCentre) radius1 = radius2 = 0;
		else if (bond && bond->bonded)
			radius1 = radius2 = bond->bondLength / 2;
		else if (bond && isSphere(body1) && isSphere(body2)) {
			radius1 *= bond->contactReach / (geom->radius1 + geom->radius2);
			radius2 *= bond->contactReach / (geom->radius1 + geom->radius2);
		}
		const Vector3r shift = scene.isPeriodic ? scene.cell->intrShiftPos(I.cellDist) : Vector3r::Zero();
		bool             central = true;
		ddem::PairSpring spring { -1, -1, phys->kn, phys->ks, 0, 0, 0, 0 };
		spring.arm1 = armOf(body1, mover1, radius1, geom->contactPoint, central);
		spring.arm2 = armOf(body2, mover2, radius2, geom->contactPoint - shift, central);
		if (bond && bond->bonded) {
			spring.bending = bond->kb;
			spring.torsion = bond->kt;
			// thin bonds leave a contact that is stiffer than they are
			const auto contact = ddem::contactStiffness(
			        bond->elasticity(), math::min(geom->radius1 + geom->radius2, bond->bondLength));
			spring.normal = math::max(spring.normal, contact.normal);
			spring.shear  = math::max(spring.shear, contact.shear);
		}
		if (!central) spring.shear = math::max(spring.normal, spring.shear);
		ddem::PairSpring damper = spring;
		damper.normal = damper.shear = damper.bending = damper.torsion = 0;
		if (bond) { // of the contact that is there or that a broken bond leaves
			const auto damping = bond->contactDamping(mover1.state->mass, mover2.state->mass);
			damper.normal      = damping.normal;
			damper.shear       = central ? damping.shear : math::max(damping.normal, damping.shear);
		}
		return Connection { spring, damper, mover1.id, mover2.id };
	}

	ddem::ParticleMass massOf(const Body& mover)
	{
		return { mover.state->mass, mover.state->inertia.minCoeff() };
	}

	/// Particles and springs of a scene, by the ids of its bodies.
	class Springs {
	public:
		explicit Springs(const Scene& of) : scene(of), place(of.bodies->size(), -1) {}

		/// \param id1,id2 bodies that are named where this connection sets the bound
		void add(Connection connection, Body::id_t id1, Body::id_t id2)
		{
			connection.spring.first = connection.damper.first = placeOf(connection.mover1);
			connection.spring.second = connection.damper.second = placeOf(connection.mover2);
			springs.push_back(connection.spring);
			if (connection.damper.normal > 0 || connection.damper.shear > 0)
				dampers.push_back(connection.damper);
			names.emplace_back(id1, id2);
		}

		BondedStableStep stableStep() const
		{
			const ddem::PairSpring* ruling   = nullptr;
			const Real              undamped = ddem::stableStep(particles, springs, &ruling);
			BondedStableStep        found {
                                ddem::dampedStableStep(undamped, ddem::stableStep(particles, dampers)), -1, -1
			};
			if (ruling) std::tie(found.id1, found.id2) = names[size_t(ruling - springs.data())];
			return found;
		}

	private:
		/// -1 for a body that nothing moves
		int placeOf(Body::id_t mover)
		{
			int& p = place[size_t(mover)];
			if (p < 0 && moves(*(*scene.bodies)[mover])) {
				p = int(particles.size());
				particles.push_back(massOf(*(*scene.bodies)[mover]));
			}
			return p;
		}

		const Scene&                                   scene;
		std::vector<int>                               place;
		std::vector<ddem::ParticleMass>                particles;
		std::vector<ddem::PairSpring>                  springs, dampers;
		std::vector<std::pair<Body::id_t, Body::id_t>> names;
	};

	/// Whether a platen is closer to the centre of a sphere than twice its radius; never for other shapes.
	bool isNear(const Body& platen, const Vector3r& centre, Real radius)
	{
		const Vector3r branch = centre - platen.state->pos;
		if (const auto* wall = dynamic_cast<const Wall*>(platen.shape.get()))
			return math::abs(branch[wall->axis]) <= 2 * radius;
		if (const auto* box = dynamic_cast<const Box*>(platen.shape.get())) {
			const Vector3r local = platen.state->ori.conjugate() * branch;
			return (local.cwiseAbs() - box->extents).cwiseMax(Vector3r::Zero()).norm() <= 2 * radius;
		}
		Real     depth = 0;
		Vector3r normal;
		const auto* round = dynamic_cast<const RoundPlaten*>(platen.shape.get());
		return round && round->overlap(platen.state->se3, centre, radius, depth, normal) && depth >= -radius;
	}

	/// Platens that spheres may come to touch before anybody looks again.
	void addElasticWalls(const Scene& scene, Springs& springs)
	{
		for (const auto& wallBody : *scene.bodies) {
			const auto* material
			        = wallBody ? dynamic_cast<const ElasticWallMat*>(wallBody->material.get()) : nullptr;
			if (!material) continue;
			for (const auto& body : *scene.bodies) {
				const auto* sphere = body ? dynamic_cast<const Sphere*>(body->shape.get()) : nullptr;
				if (!sphere || !dynamic_cast<const BondedMat*>(body->material.get())) continue;
				if (!isNear(*wallBody, body->state->pos, sphere->radius)) continue;
				const auto touching = scene.interactions->find(wallBody->id, body->id);
				if (touching && touching->isReal()) continue; // counted already
				const Real spring = ddem::wallSpring(sphere->radius, material->stiffness);
				springs.add(
				        { { -1, -1, spring, 0, 0, 0, 0, 0 }, { -1, -1, 0, 0, 0, 0, 0, 0 }, wallBody->id,
				          moverOf(scene, body->id).id },
				        wallBody->id, body->id);
			}
		}
	}

	const TimeStepper* activeTimeStepper(const Scene& scene)
	{
		for (const auto& engine : scene.engines)
			if (const auto* stepper = dynamic_cast<const TimeStepper*>(engine.get());
			    stepper && stepper->active)
				return stepper;
		return nullptr;
	}

} // namespace

BondedStableStep bondedStableStep(const Scene& scene)
{
	Springs springs(scene);
	for (const auto& I : *scene.interactions)
		if (const auto connection = connectionOf(scene, *I)) springs.add(*connection, I->getId1(), I->getId2());
	addElasticWalls(scene, springs);
	return springs.stableStep();
}

void BondedStepGuard::see(const Scene& scene, const Interaction& I)
{
	formed                = true;
	const auto connection = connectionOf(scene, I);
	if (!connection) return;
	std::vector<ddem::ParticleMass> masses; // as if it were their only spring
	ddem::PairSpring                spring = connection->spring;
	const auto                      placeOf = [&](Body::id_t id) {
                const Body& mover = *(*scene.bodies)[id];
                if (!moves(mover)) return -1;
                masses.push_back(massOf(mover));
                return int(masses.size()) - 1;
	};
	spring.first  = placeOf(connection->mover1);
	spring.second = placeOf(connection->mover2);
	if (scene.dt > ddem::stableStep(masses, { spring })) above = true;
}

bool BondedStepGuard::isDue(const Scene& scene, bool told) const
{
	const long since = scene.iter - lastLook;
	const bool same = known == &scene && bonds == BondedPhys::bondsMade && since >= 0 && scene.dt <= stable;
	return !same || above || (since >= contactInterval && (formed || !told)) || since >= lookInterval;
}

void BondedStepGuard::check(const Scene& scene)
{
	const BondedStableStep bound = bondedStableStep(scene);
	formed = above = false;
	known          = &scene;
	bonds          = BondedPhys::bondsMade;
	lastLook       = scene.iter;
	stable         = bound.step;
	if (scene.dt <= bound.step) return;
	std::ostringstream text;
	text << "O.dt = " << scene.dt << " s is above the critical time step " << bound.step
	     << " s, set by bodies #" << bound.id1 << " and #" << bound.id2 << " in step " << scene.iter
	     << "; the simulation would blow up: ";
	if (const auto* stepper = activeTimeStepper(scene))
		text << stepper->getClassName()
		     << " sets O.dt: lower its timestepSafetyCoefficient, or leave it out and ";
	text << "set O.dt = ddem.bonded.time_step(0.8)";
	throw std::runtime_error(text.str());
}

} // namespace yade
