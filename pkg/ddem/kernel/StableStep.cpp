// GPL v2 or later, see LICENSE.
#include <pkg/ddem/kernel/StableStep.hpp>

#include <Eigen/Eigenvalues>

#include <algorithm>

namespace yade::ddem {

namespace {

	constexpr int corePlace = 6, rotationPlace = 8;

	/// Row of ∂(g·Δu_e)/∂(unknowns) with Δu_e = u_e − u_i − φ e_z × r_e, added to a strain row.
	void addRelativeDisplacement(const TriangleReference<double>& reference, int e, const PlaneVector<double>& g, bool rotates, Eigen::Ref<Eigen::RowVectorXd> row)
	{
		row[2 * e] += g.x;
		row[2 * e + 1] += g.y;
		row[corePlace] -= g.x;
		row[corePlace + 1] -= g.y;
		if (rotates) row[rotationPlace] -= dot(g, turned(reference.arm[e]));
	}

} // namespace

ElementMatrix elementStiffness(const TriangleReference<double>& reference, const TriangleStiffness& stiffness, double thickness, RotationTreatment rotation)
{
	const bool      rotates = rotation == RotationTreatment::Cosserat;
	const double    lambda  = stiffness.bulk - 2. / 3 * stiffness.shear;
	Eigen::Matrix3d moduli; // engineering shear in the third place
	moduli << lambda + 2 * stiffness.shear, lambda, 0, lambda, lambda + 2 * stiffness.shear, 0, 0, 0, stiffness.shear;
	ElementMatrix matrix = ElementMatrix::Zero();
	const double  twice  = reference.twiceSubArea();
	for (int k = 0; k < 3; k++) {
		const int                   next = (k + 1) % 3;
		const PlaneVector<double>   ga   = (-1 / twice) * turned(reference.arm[next]);
		const PlaneVector<double>   gb   = (1 / twice) * turned(reference.arm[k]);
		Eigen::Matrix<double, 3, 9> b    = Eigen::Matrix<double, 3, 9>::Zero();
		for (int side = 0; side < 2; side++) {
			const int                  e = side == 0 ? k : next;
			const PlaneVector<double>& g = side == 0 ? ga : gb;
			Eigen::RowVectorXd         xx = Eigen::RowVectorXd::Zero(9), yy = xx, xy = xx;
			addRelativeDisplacement(reference, e, { g.x, 0 }, rotates, xx);
			addRelativeDisplacement(reference, e, { 0, g.y }, rotates, yy);
			addRelativeDisplacement(reference, e, { g.y, g.x }, rotates, xy);
			b.row(0) += xx;
			b.row(1) += yy;
			b.row(2) += xy;
		}
		matrix += 0.5 * twice * thickness * b.transpose() * moduli * b;
	}
	if (rotates) {
		Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(9);
		for (int e = 0; e < 3; e++)
			addRelativeDisplacement(reference, e, (1. / 3) * rotationGradient(reference.arm[e]), rotates, row);
		matrix += reference.area() * thickness * stiffness.shear * stiffness.rotationStiffness * row.transpose() * row;
	}
	return matrix;
}

ElementVector elementMass(const LumpedMass& mass)
{
	ElementVector diagonal;
	diagonal << mass.vertex, mass.vertex, mass.vertex, mass.vertex, mass.vertex, mass.vertex, mass.core, mass.core, mass.inertia;
	return diagonal;
}

double highestFrequency(const TriangleReference<double>& reference, const TriangleStiffness& stiffness, double thickness, const LumpedMass& mass, RotationTreatment rotation)
{
	ElementMatrix matrix  = elementStiffness(reference, stiffness, thickness, rotation);
	ElementVector inverse = elementMass(mass).cwiseInverse().cwiseSqrt();
	if (rotation != RotationTreatment::Cosserat) inverse[rotationPlace] = 0; // no unknown there
	matrix = inverse.asDiagonal() * matrix * inverse.asDiagonal();
	const Eigen::SelfAdjointEigenSolver<ElementMatrix> solver(matrix, Eigen::EigenvaluesOnly);
	return std::sqrt(std::max(0., solver.eigenvalues().maxCoeff()));
}

} // namespace yade::ddem
