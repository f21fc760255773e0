// GPL v2 or later, see LICENSE.
// Legs of a path of prescribed strains and stresses through a material point.
#pragma once

#include <pkg/ddem/kernel/algebra/PlaneTensor.hpp>

#include <array>
#include <cstddef>
#include <string>

namespace yade::ddem {

/// What a component of a path prescribes.
enum class Control { Strain, Stress };

/// One leg of a path: every component goes linearly from where it is to its target, as a strain [-] or as
/// a stress [Pa], within `duration` [s]. Uniaxial stress is yy by strain and xx, zz by stress;
/// plane strain has zz by strain, target 0.
struct PathLeg {
	std::array<Control, 4> control;  ///< of xx, yy, zz, xy
	PlaneTensor            target;   ///< strains or stresses at the end of the leg
	double                 duration; ///< [s], > 0
	std::size_t            steps;    ///< > 0

	/// \throws std::invalid_argument for a leg that cannot be run, or records `every` no step.
	void validate(std::size_t every) const;
	/// What to say where no strain gives the stresses asked for.
	std::string notBorne(double time, const std::array<double, 4>& stress) const;
};

/// xx, yy, zz, xy.
inline std::array<double, 4> componentsOf(const PlaneTensor& t) { return { { t.xx, t.yy, t.zz, t.xy } }; }
inline PlaneTensor           tensorOf(const std::array<double, 4>& c) { return { c[0], c[1], c[2], c[3] }; }

/// \throws std::invalid_argument unless pre-existing damage is finite and positive semi-definite.
void checkInitialDamage(const PlaneTensor& damage);

} // namespace yade::ddem
