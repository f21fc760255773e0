// GPL v2 or later, see LICENSE.
// The deformable triangle: relative displacements, strains, and nodal forces (Zubelewicz 2018, sections 2 and 4.1).
#pragma once

#include <pkg/ddem/kernel/triangles/TriangleGeometry.hpp>

namespace yade::ddem {

/// Rotation of the element's frame: R = [c −s; s c] turns reference directions into current ones.
template <class Number> struct PlaneRotation {
	Number c, s;

	PlaneVector<Number> operator*(const PlaneVector<Number>& a) const
	{
		return { c * a.x - s * a.y, s * a.x + c * a.y };
	}
	PlaneVector<Number> back(const PlaneVector<Number>& a) const
	{
		return { c * a.x + s * a.y, c * a.y - s * a.x };
	}
};

/// Strain of the three sub-elements; in-plane components, since ε_zz = 0.
template <class Number> using SubElementTensors = std::array<InPlaneTensor<Number>, 3>;

/// Δu_e of the three vertices, in the element's frame [m].
template <class Number> using RelativeDisplacements = std::array<PlaneVector<Number>, 3>;

/** Relative displacement of a vertex in the element's frame [m], eq. 1 with finite rotation:
 * Δu_e = Rᵀ(x_e − x_i) − r_e.
 * The paper's u_e − (u_i + φ × r_e) is its linearisation. This form is objective:
 * a rigid motion through any angle gives zero.
 */
template <class Number>
inline PlaneVector<Number> relativeDisplacement(
        const PlaneRotation<Number>& frame, const PlaneVector<Number>& fromCentre, const PlaneVector<Number>& arm)
{
	return frame.back(fromCentre) - arm;
}

/** Strain of sub-element k, the triangle (centre, k, k+1), eqs. 9–12.
 * The displacement is linear and zero at the centre: Δu_k N_a + Δu_k+1 N_b with ∇N_a = (b_y, −b_x)/A2, ∇N_b = (−a_y,
 * a_x)/A2, a = r_k, b = r_k+1.
 * \param inverseTwiceArea 1/A2 [1/m²], A2 = a × b.
 */
template <class Number>
inline InPlaneTensor<Number> subElementStrain(
        const PlaneVector<Number>& a, const PlaneVector<Number>& b, const PlaneVector<Number>& ua,
        const PlaneVector<Number>& ub, const Number& inverseTwiceArea)
{
	return { inverseTwiceArea * (ua.x * b.y - ub.x * a.y),
		 inverseTwiceArea * (ub.y * a.x - ua.y * b.x),
		 Number(0.5) * inverseTwiceArea * (ub.x * a.x - ua.x * b.x + ua.y * b.y - ub.y * a.y) };
}

template <class Number>
inline SubElementTensors<Number>
subElementStrains(const TriangleReference<Number>& reference, const RelativeDisplacements<Number>& du)
{
	const Number              inverse = Number(1) / reference.twiceSubArea();
	SubElementTensors<Number> strain;
	for (int k = 0; k < 3; k++) {
		const int next = (k + 1) % 3;
		strain[k]      = subElementStrain(reference.arm[k], reference.arm[next], du[k], du[next], inverse);
	}
	return strain;
}

/** Forces q_e = ∂U/∂Δu_e of the sub-elements' stresses on the three vertices, in the element's frame [N],
 * eq. 15 without its rotation part. Vertex e belongs to sub-elements e and e−1. h S_k ∇N = (h/2)(b_y, −b_x) needs
 * no area: the half edges opposite do.
 */
template <class Number>
inline RelativeDisplacements<Number> stressForces(
        const TriangleReference<Number>& reference, const SubElementTensors<Number>& stress, const Number& thickness)
{
	RelativeDisplacements<Number> force;
	const Number                  half = Number(0.5) * thickness;
	for (int e = 0; e < 3; e++) {
		const int  next = (e + 1) % 3, previous = (e + 2) % 3;
		// sub-element (e, e+1): S_k ∇N_a = ½(b_y, −b_x)
		const auto own    = stress[e] * (-turned(reference.arm[next]));
		// sub-element (e−1, e): S_k ∇N_b = ½(−a_y, a_x)
		const auto before = stress[previous] * turned(reference.arm[previous]);
		force[e]          = half * (own + before);
	}
	return force;
}

/// t_e/|r_e| = (e_z × r_e)/|r_e|² [1/m]: what a vertex contributes to the rotation strain, eqs. 13–14.
template <class Number> inline PlaneVector<Number> rotationGradient(const PlaneVector<Number>& arm)
{
	return (Number(1) / dot(arm, arm)) * turned(arm);
}

/// Rotation-induced strain ε_φ [-], eq. 2: the mean rotation of the vertices relative to the core.
template <class Number>
inline Number rotationStrain(const TriangleReference<Number>& reference, const RelativeDisplacements<Number>& du)
{
	Number sum = dot(rotationGradient(reference.arm[0]), du[0]);
	sum += dot(rotationGradient(reference.arm[1]), du[1]);
	sum += dot(rotationGradient(reference.arm[2]), du[2]);
	return Number(1. / 3) * sum;
}

/** Adds the forces that the rotation strain causes, h S μ β_φ ε_φ ∂ε_φ/∂Δu_e, to q_e [N], eq. 3.
 * \param stress μ β_φ ε_φ [Pa]
 */
template <class Number>
inline void addRotationForces(
        const TriangleReference<Number>& reference, const Number& stress, const Number& thickness,
        RelativeDisplacements<Number>& force)
{
	const Number scale = Number(1. / 3) * thickness * reference.area() * stress;
	for (int e = 0; e < 3; e++)
		force[e] = force[e] + scale * rotationGradient(reference.arm[e]);
}

/** Moment of the element's forces on its core [N·m], eq. 4 with the current arms: Σ (Δu_e + r_e) × q_e.
 * With Σ R q_e as the core's force and −R q_e on the vertices, both momenta balance element by element.
 */
template <class Number>
inline Number coreMoment(
        const TriangleReference<Number>& reference, const RelativeDisplacements<Number>& du,
        const RelativeDisplacements<Number>& force)
{
	Number sum = cross(du[0] + reference.arm[0], force[0]);
	sum += cross(du[1] + reference.arm[1], force[1]);
	sum += cross(du[2] + reference.arm[2], force[2]);
	return sum;
}

/// Isotropic plane-strain stress, in-plane components [Pa]: σ = λ tr ε 1 + 2μ ε, λ = B − 2μ/3.
template <class Number>
inline InPlaneTensor<Number> elasticStress(const InPlaneTensor<Number>& strain, const Number& lambda, const Number& mu)
{
	const Number pressure = lambda * (strain.xx + strain.yy);
	const Number twice    = mu + mu;
	return { pressure + twice * strain.xx, pressure + twice * strain.yy, twice * strain.xy };
}

/// ½ σ:ε [J/m³] in plane strain.
template <class Number>
inline Number energyDensity(const InPlaneTensor<Number>& stress, const InPlaneTensor<Number>& strain)
{
	return Number(0.5) * (stress.xx * strain.xx + stress.yy * strain.yy) + stress.xy * strain.xy;
}

} // namespace yade::ddem
