// GPL v2 or later, see LICENSE.
// The frame in which an element measures its strain: three ways to treat rotation, each a type of its own so that
// a scene pays only for what it picks.
#pragma once

#include <pkg/ddem/kernel/triangles/TriangleElement.hpp>

#include <cmath>
#include <utility>

namespace yade::ddem {

/// How elements follow rotation.
enum class RotationTreatment {
	None,         ///< R = 1: small rotations, cheapest;
	              ///< angular momentum balances to first order in the rotation only
	Corotational, ///< R from the polar decomposition of the vertices' mean deformation gradient;
	              ///< the core does not rotate by itself
	Cosserat      ///< R is the rotation of the core, a degree of freedom with inertia, tied to the vertices by β_φ
};

/** Mean deformation gradient of the three vertices, reduced to what the rotation needs: a = F_xx + F_yy,
 * b = F_yx − F_xy; tan θ = b/a. In two dimensions the polar rotation has this closed form,
 * and ∂θ/∂x_e follows from it.
 */
template <class Number> struct MeanRotation {
	Number a, b;

	MeanRotation(const TriangleReference<Number>& reference, const RelativeDisplacements<Number>& fromCentre)
	{
		a = Number(0);
		b = Number(0);
		for (int e = 0; e < 3; e++) {
			const PlaneVector<Number> g = vertexGradient(reference, e);
			a                           = a + dot(fromCentre[e], g);
			b                           = b + cross(g, fromCentre[e]);
		}
	}
	/// ∇L_e of the linear triangle [1/m].
	static PlaneVector<Number> vertexGradient(const TriangleReference<Number>& reference, int e)
	{
		const PlaneVector<Number> opposite = reference.arm[(e + 2) % 3] - reference.arm[(e + 1) % 3];
		return (Number(0.5) / reference.area()) * turned(opposite);
	}
	/// ∂θ/∂x_e [1/m].
	PlaneVector<Number> angleGradient(const TriangleReference<Number>& reference, int e) const
	{
		const PlaneVector<Number> g       = vertexGradient(reference, e);
		const Number              inverse = Number(1) / (a * a + b * b);
		return { -inverse * (a * g.y + b * g.x), inverse * (a * g.x - b * g.y) };
	}
};

/// Forces of an element in space: on its vertices, on its core, and the moment on its core.
template <class Number> struct ElementForces {
	std::array<PlaneVector<Number>, 3> vertex;
	PlaneVector<Number>                core;
	Number                             moment;
};

/// Sine and cosine of one number; SIMD batches bring their own, which does the work both have in common once.
template <class Number> inline std::pair<Number, Number> sincos(const Number& angle)
{
	using std::cos;
	using std::sin;
	return { sin(angle), cos(angle) };
}

struct FrameNone {
	static constexpr bool                           coreRotates = false;
	template <class Number>
	static PlaneRotation<Number>
	rotation(const TriangleReference<Number>&, const RelativeDisplacements<Number>&, const Number&)
	{
		return { Number(1), Number(0) };
	}
	template <class Number>
	static ElementForces<Number> distribute(
	        const TriangleReference<Number>&,
	        const RelativeDisplacements<Number>&,
	        const PlaneRotation<Number>&,
	        const RelativeDisplacements<Number>&,
	        const RelativeDisplacements<Number>& q)
	{
		return { { -q[0], -q[1], -q[2] }, q[0] + q[1] + q[2], Number(0) };
	}
};

struct FrameCorotational {
	static constexpr bool coreRotates = false;
	template <class Number>
	static PlaneRotation<Number> rotation(
	        const TriangleReference<Number>& reference, const RelativeDisplacements<Number>& fromCentre,
	        const Number&)
	{
		using std::sqrt;
		const MeanRotation<Number> mean(reference, fromCentre);
		const Number               inverse = Number(1) / sqrt(mean.a * mean.a + mean.b * mean.b);
		return { inverse * mean.a, inverse * mean.b };
	}
	/** The frame depends on the vertices, so the moment it carries goes back to them as m ∂θ/∂x_e: without this
	 * term the forces would not derive from an energy, and angular momentum would drift by
	 * the square of the strain. */
	template <class Number>
	static ElementForces<Number> distribute(
	        const TriangleReference<Number>&     reference,
	        const RelativeDisplacements<Number>& fromCentre,
	        const PlaneRotation<Number>&              frame,
	        const RelativeDisplacements<Number>& du,
	        const RelativeDisplacements<Number>& q)
	{
		const MeanRotation<Number> mean(reference, fromCentre);
		const Number               moment = coreMoment(reference, du, q);
		ElementForces<Number>      result { {}, frame * (q[0] + q[1] + q[2]), Number(0) };
		for (int e = 0; e < 3; e++)
			result.vertex[e] = moment * mean.angleGradient(reference, e) - frame * q[e];
		return result;
	}
};

struct FrameCosserat {
	static constexpr bool coreRotates = true;
	template <class Number>
	static PlaneRotation<Number>
	rotation(const TriangleReference<Number>&, const RelativeDisplacements<Number>&, const Number& coreRotation)
	{
		const auto [sine, cosine] = sincos(coreRotation);
		return { cosine, sine };
	}
	template <class Number>
	static ElementForces<Number> distribute(
	        const TriangleReference<Number>& reference,
	        const RelativeDisplacements<Number>&,
	        const PlaneRotation<Number>&              frame,
	        const RelativeDisplacements<Number>& du,
	        const RelativeDisplacements<Number>& q)
	{
		return { { -(frame * q[0]), -(frame * q[1]), -(frame * q[2]) },
			 frame * (q[0] + q[1] + q[2]),
			 coreMoment(reference, du, q) };
	}
};

} // namespace yade::ddem
