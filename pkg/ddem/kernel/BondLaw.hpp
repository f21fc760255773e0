// GPL v2 or later, see LICENSE.
// The elastic bond: forces and moments on two particles from their positions and orientations.
//
// The bond is one element of the geometrically exact beam between the particles' centres (Simo, Comput. Methods Appl. Mech. Eng. 49, 1985), with one
// integration point at its middle, which keeps a short beam free of shear locking (Hughes, Taylor, Kanoknukulchai, Int. J. Numer. Meth. Eng. 11, 1977).
// To first order it is the bond of ESyS-Particle (Wang, Acta Geotechnica 4, 2009): shear = (u2 - u1)_t - (d0/2)(φ1 + φ2) × n, bending and twist = φ2 - φ1.
//
// The frames Λ1, Λ2 turn with the particles and coincide when the bond is made, first axis along the bond. The middle frame Λ is half way between them:
//   Γ = Λᵀ(x2 - x1) - d0 e1                    stretch and shear,
//   θ = rotation vector of Λ1ᵀΛ2               torsion and bending,
//   U = ½ (kn Γ1² + ks (Γ2² + Γ3²)) + ½ (kt θ1² + kb (θ2² + θ3²)).
// Forces and moments are the exact derivatives of U. So the bond is conservative for any radii and any rotation below π, and because U does not change when
// both particles move and turn together, linear and angular momentum are conserved to round-off (objectivity: Crisfield, Jelenić, Proc. R. Soc. A 455, 1999).
// Loads are total, not incremental: nothing drifts. No acos or asin is taken: at small angles they lose half of the digits.
#pragma once

#include <pkg/ddem/kernel/BondSection.hpp>

#include <Eigen/Geometry>

namespace yade::ddem {

/// What a bond remembers of the moment it was made.
struct Bond {
	BondStiffness      stiffness;
	double             length; ///< d0 [m]
	Eigen::Quaterniond frame1; ///< the bond's frame in the axes of particle 1, first axis from particle 1 to 2
	Eigen::Quaterniond frame2; ///< the same frame in the axes of particle 2
};

/// Loads of the cross-section in the middle of the bond, along its axes; the first is the bond's own. Tension positive.
struct BondResultants {
	Eigen::Vector3d force;  ///< normal force, two shear forces [N]
	Eigen::Vector3d moment; ///< torsion, two bending moments [N·m]
};

/// What the bond does to its particles. The force on particle 2 is -force.
struct BondLoads {
	Eigen::Vector3d force;   ///< on particle 1 [N]
	Eigen::Vector3d moment1; ///< on particle 1, about its centre [N·m]
	Eigen::Vector3d moment2; ///< on particle 2, about its centre [N·m]
	Eigen::Vector3d axis;    ///< the bond's direction, first axis of the middle frame [-]
	BondResultants  section;
	double          energy; ///< stored [J]
};

/// A bond without load between particles at rest in these orientations. \param branch x2 - x1 [m], not zero
inline Bond
makeBond(const BondStiffness& stiffness, const Eigen::Vector3d& branch, const Eigen::Quaterniond& orientation1, const Eigen::Quaterniond& orientation2)
{
	const Eigen::Quaterniond frame = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), branch);
	return { stiffness, branch.norm(), orientation1.conjugate() * frame, orientation2.conjugate() * frame };
}

/// Factors that turn the vector part v of a unit quaternion into its rotation vector: θ = 2 f v with f = asin|v|/|v|, and (1 - f)/|v|² for its derivative.
struct HalfAngle {
	double factor;     ///< f
	double complement; ///< (1 - f)/|v|²
};

/// \param scalar scalar part of the quaternion, not negative \param squared |v|²
inline HalfAngle halfAngle(double scalar, double squared)
{
	if (squared < 1e-3) { // the series is exact to the last digit here, and needs no special case at zero
		const double complement = -(1. / 6 + squared * (3. / 40 + squared * (15. / 336 + squared * (105. / 3456 + squared * 945. / 42240))));
		return { 1 - squared * complement, complement };
	}
	const double sine = std::sqrt(squared), factor = std::atan2(sine, scalar) / sine;
	return { factor, (1 - factor) / squared };
}

/// a b. Inlined by force: compilers see too many calls of it to do so, and three calls a bond show in the time of a whole step.
[[gnu::always_inline]] inline Eigen::Quaterniond product(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b)
{
	return Eigen::Quaterniond(
	        a.w() * b.w() - a.x() * b.x() - a.y() * b.y() - a.z() * b.z(),
	        a.w() * b.x() + a.x() * b.w() + a.y() * b.z() - a.z() * b.y(),
	        a.w() * b.y() + a.y() * b.w() + a.z() * b.x() - a.x() * b.z(),
	        a.w() * b.z() + a.z() * b.w() + a.x() * b.y() - a.y() * b.x());
}

/// Matrix of the rotation half way between two unit quaternions less than π apart: that of their sum, whose length need not be one.
inline Eigen::Matrix3d rotationBetween(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b)
{
	const double    w = a.w() + b.w(), x = a.x() + b.x(), y = a.y() + b.y(), z = a.z() + b.z();
	const double    s = 2 / (w * w + x * x + y * y + z * z), sx = s * x, sy = s * y, sz = s * z;
	Eigen::Matrix3d matrix;
	matrix << 1 - (y * sy + z * sz), x * sy - w * sz, x * sz + w * sy, //
	        x * sy + w * sz, 1 - (x * sx + z * sz), y * sz - w * sx,   //
	        x * sz - w * sy, y * sz + w * sx, 1 - (x * sx + y * sy);
	return matrix;
}

/** Loads of a bond.
 * \param branch x2 - x1 [m]
 * \param orientation1,orientation2 unit quaternions, body to world
 */
inline BondLoads bondLoads(const Bond& bond, const Eigen::Vector3d& branch, const Eigen::Quaterniond& orientation1, const Eigen::Quaterniond& orientation2)
{
	const Eigen::Quaterniond end1 = product(orientation1, bond.frame1);
	Eigen::Quaterniond       end2 = product(orientation2, bond.frame2);
	if (end1.dot(end2) < 0) end2.coeffs() = -end2.coeffs(); // the shorter of the two rotations between them
	const Eigen::Quaterniond relative = product(end1.conjugate(), end2);
	const Eigen::Vector3d    v        = relative.vec();
	const Eigen::Matrix3d    axes     = rotationBetween(end1, end2); // columns: the bond's axes in the world

	const Eigen::Vector3d local = axes.transpose() * branch;
	const HalfAngle       half  = halfAngle(relative.w(), v.squaredNorm());
	const Eigen::Vector3d stretch(local.x() - bond.length, local.y(), local.z());
	const Eigen::Vector3d rotation = 2 * half.factor * v;

	const BondStiffness& k = bond.stiffness;
	BondLoads            loads;
	Eigen::Vector3d&     force  = loads.section.force;
	Eigen::Vector3d&     moment = loads.section.moment;
	force << k.normal * stretch.x(), k.shear * stretch.y(), k.shear * stretch.z();
	moment << k.torsion * rotation.x(), k.bending * rotation.y(), k.bending * rotation.z();
	loads.energy = 0.5 * (force.dot(stretch) + moment.dot(rotation));

	// δU = force·δΓ + moment·δθ. With spins w1, w2 of the ends, in the middle frame: δθ = v v·w (1 - f)/|v|² + f w for w = w2 - w1, and the middle frame
	// spins with ½(w1 + w2) - ½ g × (w2 - w1), g = v/(1 + scalar) = tan(θ/4) along the axis.
	const Eigen::Vector3d conjugate = half.factor * moment + half.complement * moment.dot(v) * v;
	const Eigen::Vector3d couple    = 0.5 * local.cross(force);
	const Eigen::Vector3d swing     = couple.cross(v) / (1 + relative.w()) + conjugate;
	loads.force                     = axes * force;
	loads.moment1                   = axes * (couple + swing);
	loads.moment2                   = axes * (couple - swing);
	loads.axis                      = axes.col(0);
	return loads;
}

} // namespace yade::ddem
