// GPL v2 or later, see LICENSE.
// A NewtonIntegrator that moves bonded spheres in arrays.
#pragma once

#include <pkg/bonded/BondedSpheres.hpp>
#include <pkg/ddem/Onlookers.hpp>

namespace yade {

class BondedInteractionLoop;

class BondedNewtonIntegrator : public NewtonIntegrator {
public:
	virtual ~BondedNewtonIntegrator() = default;
	void action() override;

	/// The engine of a scene that moves spheres in arrays; null where there is none, or what it is told can only be
	/// done through State.
	static BondedNewtonIntegrator* in(const Scene& scene);
	/// Number of spheres that it moved in arrays in the last step.
	long moved() const { return inArrays; }
	/// Spheres that it moves in this step of a scene, null where there are none. For other engines, too:
	/// after loading, an engine that has not acted yet does not know its scene.
	BondedSpheres* spheres(const Scene& of) const;

	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(BondedNewtonIntegrator, NewtonIntegrator,
		"A :yref:`NewtonIntegrator`, with the same arguments, that moves spheres of :yref:`BondedMat` in "
		"arrays which it shares with :yref:`BondedInteractionLoop`, several times as fast; all other bodies as "
		"its base does. Use it in place of NewtonIntegrator.\n\n"
		":yref:`State` of these spheres, and the forces of bonds in :yref:`O.forces<Omega.forces>`, are "
		"written for whoever may look: at the end of a run, in O.step, for engines that are due and are not "
		"known to leave spheres alone, for the collider; and what they change is taken up. A :yref:`PyRunner` "
		"brings those spheres up to date that it touches. An engine that acts in every step, as "
		":yref:`TriaxialStressController`, costs that in every step. After O.pause(), too, "
		"State is that of the last step. While a run goes on in the background, a shell reads State that may "
		"be some steps old, and what it sets is lost: pause first.\n\n"
		"Spheres that only YADE can move are left to it: members of clumps, spheres that a "
		":yref:`KinematicEngine` drives, without damping of their own (:yref:`State.isDamped`), outside of "
		":yref:`mask<NewtonIntegrator.mask>` or with all degrees of freedom blocked; all of them with density "
		"scaling or periodic boundaries, and where the interactions are not those of a "
		"BondedInteractionLoop.\n\n"
		"**Energy.** The kinetic energy of these spheres is :math:`\\frac12 m\\,v_{-1/2}\\cdot v_{+1/2}`, "
		"which belongs to the positions of the other energies; NewtonIntegrator books that of "
		":math:`v_{-1/2}`. Works of gravity and damping are those of the mean velocity.\n\n"
		"Errors: RuntimeError naming the sphere where its motion is not a number, or its mass is not "
		"positive; where it stands before BondedInteractionLoop in O.engines.",
		/*attrs*/,
		/*ctor*/,
		.add_property("moved",&BondedNewtonIntegrator::moved,
			"Number of spheres that it moved in arrays in the last step; 0: all bodies were moved as by "
			"its base")
	);
	// clang-format on

private:
	void moveInArrays(BondedInteractionLoop& loop, BondedSpheres& spheres);
	void moveOthers(const std::vector<Body::id_t>& others);
	void book(const ddem::SphereSums& sums);
	void show(BondedInteractionLoop& loop, BondedSpheres& spheres);
	[[noreturn]] void stopAtNotFinite(const BondedSpheres& spheres) const;

	Showings showings;
	long     inArrays = 0;
};
REGISTER_SERIALIZABLE(BondedNewtonIntegrator);

} // namespace yade
