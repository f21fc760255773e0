// GPL v2 or later, see LICENSE.
// Parameters of the concrete damage model, checked and prepared for the inner loop.
#pragma once

#include <pkg/ddem/kernel/algebra/Parameters.hpp>
#include <pkg/ddem/kernel/laws/concrete/ConcretePower.hpp>

namespace yade::ddem {

/// P(name, default, unit, bounds, way out, doc string); Zubelewicz (2018), Tables 1 and 2. From referenceRate on they
/// are not in the tables: they say how gaps of the report and numerical limits are closed.
/// damageLimit is in the text only, without a value.
#define CONCRETE_PARAMETERS(P) \
	P(eosPressure, 1.1e9, "Pa", above(0), \
	  "It is the pressure at which the moduli have doubled, 1.1e9 Pa for concrete.", \
	  "Pressure :math:`p_{EOS}` at which the moduli have doubled.") \
	P(eosExponent, 2. / 3, "-", strictlyBetween(0, 1), \
	  "With 1 or more the pressure is infinite at a finite compression; concrete: 2/3.", \
	  "Exponent :math:`n_{EOS}` of the equation of state.") \
	P(strength, 140e6, "Pa", above(0), "For a material that does not flow, use an elastic material.", \
	  "Strength :math:`\\sigma_{p0}` of the undamaged material in the flow rule (eq. 7).") \
	P(flowFactor, 6.7, "-", above(0), "For a material that does not flow, use an elastic material.", \
	  "Factor :math:`\\Lambda_0` of the flow rate (eq. 7).") \
	P(flowExponent, .5, "-", above(0), "Concrete: 0.5.", "Exponent :math:`n_p` of the equivalent stress (eq. 7).") \
	P(rateExponent, .96, "-", between(0, 1), \
	  "1 is rate independent; above 1 the strength would fall as the rate grows.", \
	  "Exponent :math:`\\omega_p` of the strain rate (eq. 7); 1 means no rate dependence.") \
	P(frictionPressure, 600e6, "Pa", above(0), "For constant friction set frictionPressureExponent = 0.", \
	  "Pressure :math:`p_{q0}` that scales the decay of friction.") \
	P(frictionPressureExponent, .5, "-", atLeast(0), "0 is constant friction; concrete: 0.5.", \
	  "Exponent :math:`n_q` of the decay of friction with pressure.") \
	P(friction, .66, "-", fromBelow(0, 1), "It is a coefficient, not an angle in degrees; concrete: 0.66.", \
	  "Friction :math:`q_0` without pressure (eq. 5); a number below 1, not an angle.") \
	P(closedGrowth, .5, "-", between(0, 1), "It is relative to the open crack; concrete: 0.5.", \
	  "Growth of damage :math:`\\xi_{c0}` in a closed crack, relative to an open one (eq. 8).") \
	P(closedEffect, .1, "-", between(0, 1), "It is relative to the open crack; concrete: 0.1.", \
	  "Effect of damage on elasticity :math:`\\xi_{c1}` in a closed crack, relative to an open one.") \
	P(fractureEnergy, 80e3, "J/m³", above(0), \
	  "It is an energy per volume (not per area), 80e3 J/m³ for concrete.", \
	  "Fracture energy :math:`G_f` (eq. 8); :yref:`DeformableTriangle.fractureEnergy` overrides it for one " \
	  "triangle.") \
	P(damageExponent, 2, "-", above(0), "Concrete: 2.", "Exponent :math:`n_f` of the damage parameter.") \
	P(damageLimit, 1, "-", between(0, 1), "1 is complete loss of stiffness.", \
	  "Largest loss of stiffness :math:`\\eta_{max}`, at most 1.") \
	P(closureBand, 1e6, "Pa", atLeast(0), "0 closes cracks at zero stress.", \
	  "Crack-normal stress over which a closing crack recovers; 0: at once.") \
	P(referenceRate, 1, "1/s", above(0), "Zubelewicz (2018) uses 1/s.", \
	  "Strain rate :math:`\\dot e_0` that scales the strain rate (eq. 7).") \
	P(sharingTolerance, .05, "-", strictlyBetween(0, 1), \
	  "It is relative to the largest principal stress, 0.05 for concrete.", \
	  "Principal stresses closer than this share of the largest share the flow, so that its direction does not " \
	  "jitter " \
	  "where they coincide.") \
	P(residual, 1e-6, "-", strictlyBetween(0, 1), \
	  "It is the share of strength and stiffness that full damage leaves, 1e-6 or so.", \
	  "Share of strength and stiffness that complete damage leaves, so that nothing divides by zero.")

/// Parameters of the concrete damage model; the defaults are the high-strength concrete of Zubelewicz (2018),
/// Tables 1 and 2. Plain data: fill it, then make a PreparedConcrete of it, which checks it. SI units.
struct ConcreteParameters : ElasticParameters {
	CONCRETE_PARAMETERS(DDEM_MEMBER)
	DDEM_ENTRIES(ConcreteParameters, ElasticParameters, CONCRETE_PARAMETERS)

	/// Throws std::invalid_argument that names the parameter, its value, its unit and what to do.
	void validate() const;
};

/// Damage Ω_D from which flow counts as localised [-]: with n_f = 2 a fifth of the strength is gone. The concrete of
/// Zubelewicz (2018), Table 2, has its peak before, in tension at 0.06 to 0.19 by its rate (0.2 to 0.3 with a tenth of
/// its fracture energy), in compression at 0.2 to 0.5.
constexpr double localisedDamage = 0.5;

/// Damage parameter η_0 [-] up to which flow may wait for its turn (LawGroup::flowInterval):
/// beyond, the stiffness changes while it waits.
constexpr double patientDamage = 0.01;

/// Parameters with everything worked out that the inner loop need not repeat.
struct PreparedConcrete {
	/// Checks the parameters (throws std::invalid_argument) and prepares them.
	explicit PreparedConcrete(const ConcreteParameters& parameters = ConcreteParameters());

	ConcreteParameters parameters;
	double             lambda;              ///< B_0 − 2/3 μ_0 [Pa]
	double             twoShear;            ///< 2 μ_0 [Pa]
	double             perEosPressure;      ///< 1/p_EOS [1/Pa]
	double             perFrictionPressure; ///< 1/p_q0 [1/Pa]
	double             perReferenceRate;    ///< 1/ė_0 [s]
	double             localisedIntegrity;  ///< 1 − η_0 at localisedDamage [-]
	double             patientSquare;       ///< Ω:Ω at patientDamage [-]
	double             smallestEnergy;      ///< Fracture energy that a drawn one is raised
	                                        ///< to where it is less [J/m³]
	Power              eosPower, flowPower, ratePower, frictionPower, damagePower;
};

} // namespace yade::ddem
