// GPL v2 or later, see LICENSE.
// Body of the loop over moving spheres, compiled once per instruction set.
#pragma once

#include <pkg/bonded/kernel/SphereLoops.hpp>
#include <pkg/ddem/kernel/algebra/Lanes.hpp>
#include <pkg/ddem/kernel/algebra/LocalDamping.hpp>
#include <pkg/ddem/kernel/algebra/SpaceVector.hpp>

#include <array>

namespace yade::ddem {

/// Orientation after turning by an angle [rad] about the axis of `angle` for a step.
template <class Number>
inline SpaceRotation<Number> turned(const SpaceRotation<Number>& q, const SpaceVector<Number>& angle)
{
	const SpaceVector<Number> half   = Number(0.5) * angle;
	const Number              square = dot(half, half);
	// Series of cosine and of sine over the half angle: exact to the last digits below 0.1 rad, where a particle's
	// rotation in a step lies but for hard impacts.
	constexpr double limit = 0.01;
	Number cosine = 1. - square * (1. / 2 - square * (1. / 24 - square * (1. / 720 - square * (1. / 40320))));
	Number sine = 1. - square * (1. / 6 - square * (1. / 120 - square * (1. / 5040 - square * (1. / 362880))));
	if (any(square > Number(limit))) {
		using std::cos;
		using std::sin;
		using std::sqrt;
		const auto   large  = square > Number(limit);
		const Number length = sqrt(select(large, square, Number(1.)));
		cosine              = select(large, Number(cos(length)), cosine);
		sine                = select(large, Number(sin(length) / length), sine);
	}
	const SpaceVector<Number>   axis = sine * half;
	const SpaceRotation<Number> by { cosine, axis.x, axis.y, axis.z }, sum = by * q;
	using std::sqrt;
	const Number scale = Number(1.) / sqrt(dot(sum, sum));
	return scale * sum;
}

/// \tparam Unit names the instruction set, so that the linker keeps a copy for each
/// Flattened, as bondLoop is.
template <class Unit, class Number, unsigned effects>
[[gnu::flatten]] SphereSums
sphereLoop(const SphereArrays& a, std::size_t begin, std::size_t end, const SphereStep& step)
{
	using L = Lanes<Number>;
	using namespace SphereEffects;
	const Number dt(step.dt), g[3] = { Number(step.gravity[0]), Number(step.gravity[1]), Number(step.gravity[2]) };
	const Number damping(step.damping);
	Number translation(0.), rotation(0.), gravityWork(0.), dampingLoss(0.), speedSquared(0.), check(0.);
	for (std::size_t p = begin; p < end; p += L::width) {
		const std::ptrdiff_t place = sphereRow * std::ptrdiff_t(p);
		Number x[4], q[4], v[4], w[4], force[4], moment[4];
		L::loadRows(a.pose + place, sphereRow, x);
		L::loadRows(a.pose + place + 4, sphereRow, q);
		L::loadRows(a.velocity + place, sphereRow, v);
		L::loadRows(a.velocity + place + 4, sphereRow, w);
		L::loadRows(a.load + place, sphereRow, force);
		L::loadRows(a.load + place + 4, sphereRow, moment);
		const Number inverseMass = x[3], inverseInertia = v[3];
		Number moves(1.); // gravity has no hold on what others move
		moves = select(inverseMass > Number(0.), moves, Number(0.));
		[[maybe_unused]] Number free[4], freeRotation[4];
		if constexpr (effects & Blocked) {
			L::loadRows(a.free + place, sphereRow, free);
			L::loadRows(a.free + place + 4, sphereRow, freeRotation);
		}
		[[maybe_unused]] Number mass(0.), inertia(0.);
		if constexpr (effects & Energy) {
			mass    = L::load(a.mass + p);
			inertia = L::load(a.inertia + p);
		}
		Number square(0.);
		for (int c = 0; c < 3; c++) {
			Number acceleration = force[c] * inverseMass, fall = moves * g[c];
			Number spin = moment[c] * inverseInertia;
			if constexpr (effects & Blocked) {
				acceleration = free[c] * acceleration;
				fall         = free[c] * fall;
				spin         = freeRotation[c] * spin;
			}
			if constexpr (effects & Damping) {
				const Number damped = step.dampGravity ? acceleration + fall : acceleration;
				const Number kept   = step.dampGravity ? Number(0.) : fall;
				const Number after  = damped * localDamping(damping, damped, v[c], dt);
				const Number spun  = spin * localDamping(damping, spin, w[c], dt);
				if constexpr (effects & Energy)
					dampingLoss += dt
					        * (mass * (damped - after) * (v[c] + 0.5 * dt * (after + kept))
					           + inertia * (spin - spun) * (w[c] + 0.5 * dt * spun));
				acceleration = after + kept;
				spin         = spun;
			} else
				acceleration += fall;
			const Number before = v[c], turning = w[c];
			v[c] = before + dt * acceleration;
			w[c] = turning + dt * spin;
			if constexpr (effects & Energy) {
				translation += mass * before * v[c];
				rotation += inertia * turning * w[c];
				gravityWork += dt * mass * fall * (before + 0.5 * dt * acceleration);
			}
			square += v[c] * v[c];
			x[c] += dt * v[c];
		}
		speedSquared = select(square > speedSquared, square, speedSquared);
		// not a number where a velocity or a place is none, or infinite
		check += Number(0.) * (square + x[0] + x[1] + x[2] + w[0] + w[1] + w[2]);
		const SpaceRotation<Number> turnedBy = turned(
		        SpaceRotation<Number> { q[0], q[1], q[2], q[3] },
		        SpaceVector<Number> { dt * w[0], dt * w[1], dt * w[2] });
		const Number to[4] = { turnedBy.w, turnedBy.x, turnedBy.y, turnedBy.z };
		L::storeRows(a.pose + place, sphereRow, x);
		L::storeRows(a.pose + place + 4, sphereRow, to);
		L::storeRows(a.velocity + place, sphereRow, v);
		L::storeRows(a.velocity + place + 4, sphereRow, w);
	}
	SphereSums sums;
	sums.translation  = 0.5 * L::sum(translation);
	sums.rotation     = 0.5 * L::sum(rotation);
	sums.gravityWork  = L::sum(gravityWork);
	sums.dampingLoss  = L::sum(dampingLoss);
	sums.speedSquared = L::largest(speedSquared);
	sums.finite       = L::sum(check) == 0;
	return sums;
}

template <class Unit, class Number> SphereLoop sphereLoopFor(unsigned effects)
{
	static constexpr std::array<SphereLoop, SphereEffects::Combinations> loops {
		sphereLoop<Unit, Number, 0>, sphereLoop<Unit, Number, 1>, sphereLoop<Unit, Number, 2>,
		sphereLoop<Unit, Number, 3>, sphereLoop<Unit, Number, 4>, sphereLoop<Unit, Number, 5>,
		sphereLoop<Unit, Number, 6>, sphereLoop<Unit, Number, 7>
	};
	return loops[effects];
}

} // namespace yade::ddem
