// GPL v2 or later, see LICENSE.
// Isotropic linear elasticity.
#pragma once

#include <pkg/ddem/kernel/algebra/ElasticModuli.hpp>
#include <pkg/ddem/kernel/triangles/LawGroup.hpp>

namespace yade::ddem {

struct Elastic : LawDefaults {
	static constexpr const char* name = "Elastic";

	using Parameters = ElasticParameters;

	struct Prepared {
		Prepared(const Parameters& p) // NOLINT: parameters are meant to become prepared ones
		        : parameters(p)
		        , lambda(ElasticModuli { p.bulk, p.shear }.lambda())
		        , twoShear(2 * p.shear)
		{
			checkParameters(name, Parameters::entries(), &p);
		}
		Parameters parameters;
		double     lambda, twoShear; ///< [Pa]
	};

	// It remembers nothing, and loses nothing.
	static constexpr bool dissipates(unsigned) { return false; }
	template <class Number> struct State { };
	template <unsigned effects, class S, class Visit> static void fields(S&, Visit&&) { }
	static State<double> virgin(const Prepared&, const TriangleProperties&) { return {}; }

	template <unsigned effects, class Number>
	static PlaneTensorOf<Number> advance(
	        const Prepared&              law,
	        const Properties<Number>&,
	        const PlaneTensorOf<Number>& strain,
	        double,
	        State<Number>&)
	{
		return elasticStress(law.lambda, law.twoShear, strain);
	}
	template <unsigned effects, class Number>
	static EnergyDensities<Number> energies(
	        const Prepared&,
	        const PlaneTensorOf<Number>& strain,
	        const PlaneTensorOf<Number>& stress,
	        const State<Number>&)
	{
		// out of the plane there is initial strain only
		return { 0.5 * (stress.xx * strain.xx + stress.yy * strain.yy + stress.zz * strain.zz)
			         + stress.xy * strain.xy,
			 Number(0.),
			 Number(0.) };
	}
};

} // namespace yade::ddem
