// GPL v2 or later, see LICENSE.
// Isotropic elasticity in plane strain from bulk and shear modulus.
#pragma once

#include <pkg/ddem/kernel/algebra/PlaneTensor.hpp>

namespace yade::ddem {

/// Bulk modulus B and shear modulus μ [Pa] of an isotropic elastic material.
struct ElasticModuli {
	double bulk, shear;

	/// From Young's modulus [Pa] and Poisson's ratio [-];
	/// throws std::invalid_argument unless E > 0 and -1 < ν < 0.5.
	static ElasticModuli fromYoung(double young, double poisson);

	/// Throws std::invalid_argument unless both are positive, finite and B/μ is at most `largestBulkToShear`:
	/// beyond it Poisson's ratio is 0.5 for all purposes, linear triangles lock and the stable
	/// time step goes to zero.
	void validate() const;

	double lambda() const { return bulk - 2 * shear / 3; }                               ///< Lamé's λ [Pa]
	double young() const { return 9 * bulk * shear / (3 * bulk + shear); }               ///< Young's modulus [Pa]
	double poisson() const { return (3 * bulk - 2 * shear) / (2 * (3 * bulk + shear)); } ///< Poisson's ratio [-]
	/// P-wave modulus B + 4/3 μ [Pa]
	double planeWave() const { return bulk + 4 * shear / 3; }

	static constexpr double largestBulkToShear = 1e4;
};

/// σ = λ tr(ε) 1 + 2μ ε
template <class Number>
inline PlaneTensorOf<Number> elasticStress(double lambda, double twoShear, const PlaneTensorOf<Number>& strain)
{
	const Number volumetric = lambda * trace(strain);
	return { volumetric + twoShear * strain.xx, volumetric + twoShear * strain.yy,
		 volumetric + twoShear * strain.zz, twoShear * strain.xy };
}

/// Energy per volume [J/m³], ½ε:C:ε
template <class Number> inline Number elasticEnergy(double lambda, double twoShear, const PlaneTensorOf<Number>& strain)
{
	const Number volumetric = trace(strain);
	return 0.5 * (lambda * volumetric * volumetric + twoShear * doubleDot(strain, strain));
}

} // namespace yade::ddem
