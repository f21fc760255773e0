// GPL v2 or later, see LICENSE.
// Parameters of the concrete damage model, checked and prepared for the inner loop.
#pragma once

#include <pkg/ddem/kernel/laws/ConcretePower.hpp>

namespace yade::ddem {

/// Parameters of the concrete damage model; the defaults are the high-strength concrete of Zubelewicz (2018), Tables 1 and 2.
/// Plain data: fill it, then make a PreparedConcrete of it, which checks it. SI units. From referenceRate on they are not in the tables: they say how gaps
/// of the report and numerical limits are closed. damageLimit is in the text only, without a value.
struct ConcreteParameters {
	double bulk                     = 30e9;   ///< Bulk modulus B_0 at zero pressure [Pa]
	double shear                    = 26e9;   ///< Shear modulus μ_0 at zero pressure [Pa]
	double rotationStiffness        = 2;      ///< Stiffness β_φ of the rotation strain, as a multiple of the shear modulus [-]
	double density                  = 2400;   ///< Mass density ρ [kg/m³]
	double eosPressure              = 1.1e9;  ///< Pressure p_EOS at which the moduli have doubled [Pa]
	double eosExponent              = 2. / 3; ///< Exponent n_EOS of the equation of state, 0 < n_EOS < 1 [-]
	double strength                 = 140e6;  ///< Strength σ_p0 of the undamaged material in the flow rate [Pa]
	double flowFactor               = 6.7;    ///< Factor Λ_0 of the flow rate [-]
	double flowExponent             = 0.5;    ///< Exponent n_p of the equivalent stress in the flow rate [-]
	double rateExponent             = 0.96;   ///< Exponent ω_p of the strain rate in the flow rate; 1: no rate dependence [-]
	double frictionPressure         = 600e6;  ///< Pressure p_q0 that scales the decay of friction [Pa]
	double frictionPressureExponent = 0.5;    ///< Exponent n_q of the decay of friction; 0: constant friction [-]
	double friction                 = 0.66;   ///< Friction (dilation) q_0 at zero pressure, a number below 1, not an angle [-]
	double closedGrowth             = 0.5;    ///< Growth ξ_c0 of damage while the crack is closed, relative to open [-]
	double closedEffect             = 0.1;    ///< Effect ξ_c1 of damage on stiffness while the crack is closed, relative to open [-]
	double fractureEnergy           = 80e3;   ///< Fracture energy G_f per volume [J/m³]
	double damageExponent           = 2;      ///< Exponent n_f of the damage parameter [-]
	double damageLimit              = 1;      ///< Largest loss η_max of stiffness, at most 1 [-]
	double referenceRate            = 1;      ///< Strain rate ė_0 that scales the strain rate [1/s]
	double sharingTolerance         = 0.05;   ///< Principal stresses closer than this, relative to the largest, share the flow [-]
	double closureBand              = 1e6;    ///< Crack-normal stress over which a crack closes [Pa]; 0: closes at once at zero stress
	double residual                 = 1e-6;   ///< Share of strength and of stiffness that complete damage leaves [-]

	/// Throws std::invalid_argument that names the parameter, its value, its unit and what to do.
	void validate() const;
};

/// Damage Ω_D from which flow counts as localised [-]: with n_f = 2 a fifth of the strength is gone. The concrete of Zubelewicz (2018), Table 2, has its peak before, in tension at
/// 0.06 to 0.19 by its rate (0.2 to 0.3 with a tenth of its fracture energy), in compression at 0.2 to 0.5.
constexpr double localisedDamage = 0.5;

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
	double             smallestEnergy;      ///< Fracture energy that a drawn one is raised to where it is less [J/m³]
	Power              eosPower, flowPower, ratePower, frictionPower, damagePower;
};

} // namespace yade::ddem
