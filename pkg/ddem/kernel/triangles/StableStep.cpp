// GPL v2 or later, see LICENSE.
#include <pkg/ddem/kernel/triangles/StableStep.hpp>

#include <Eigen/Eigenvalues>

#include <algorithm>

namespace yade::ddem {

namespace {

	constexpr int corePlace = 6, rotationPlace = 8;

	/// Row of ∂(g·Δu_e)/∂(unknowns) with ∂Δu_e = u_e − u_i − φ e_z × (r_e + Δu_e), added to a strain row.
	void addRelativeDisplacement(
	        const PlaneVector<double>& arm, int e, const PlaneVector<double>& g, Eigen::Ref<Eigen::RowVectorXd> row)
	{
		row[2 * e] += g.x;
		row[2 * e + 1] += g.y;
		row[corePlace] -= g.x;
		row[corePlace + 1] -= g.y;
		row[rotationPlace] -= dot(g, turned(arm));
	}

	/// ∂θ/∂u_e of the corotational frame, in that frame [1/m].
	std::array<PlaneVector<double>, 3>
	frameGradient(const TriangleReference<double>& reference, const RelativeDisplacements<double>& shape)
	{
		const MeanRotation<double>         mean(reference, shape);
		std::array<PlaneVector<double>, 3> gradient;
		for (int e = 0; e < 3; e++)
			gradient[std::size_t(e)] = mean.angleGradient(reference, e);
		return gradient;
	}

	/// r_e + Δu_e.
	RelativeDisplacements<double>
	shapeOf(const TriangleReference<double>& reference, const RelativeDisplacements<double>& du)
	{
		return { reference.arm[0] + du[0], reference.arm[1] + du[1], reference.arm[2] + du[2] };
	}

	double lambda(const TriangleStiffness& stiffness) { return stiffness.bulk - 2. / 3 * stiffness.shear; }

} // namespace

ElementMatrix elementStiffness(
        const TriangleReference<double>&     reference,
        const TriangleStiffness&             stiffness,
        double                               thickness,
        RotationTreatment                    rotation,
        const RelativeDisplacements<double>& du)
{
	const double    normal = lambda(stiffness) + 2 * stiffness.shear;
	Eigen::Matrix3d moduli; // engineering shear in the third place
	moduli << normal, lambda(stiffness), 0, lambda(stiffness), normal, 0, 0, 0, stiffness.shear;
	const RelativeDisplacements<double>      shape    = shapeOf(reference, du);
	const double                             twice    = reference.twiceSubArea();
	const std::array<PlaneVector<double>, 3> gradient
	        = rotation == RotationTreatment::Corotational ? frameGradient(reference, shape) : shape;
	ElementMatrix                            matrix   = ElementMatrix::Zero();
	for (int k = 0; k < 3; k++) {
		const int                   next = (k + 1) % 3;
		const PlaneVector<double>   ga   = (-1 / twice) * turned(reference.arm[next]);
		const PlaneVector<double>   gb   = (1 / twice) * turned(reference.arm[k]);
		Eigen::Matrix<double, 3, 9> b    = Eigen::Matrix<double, 3, 9>::Zero();
		for (int side = 0; side < 2; side++) {
			const int                  e = side == 0 ? k : next;
			const PlaneVector<double>& g = side == 0 ? ga : gb;
			Eigen::RowVectorXd         xx = Eigen::RowVectorXd::Zero(9), yy = xx, xy = xx;
			addRelativeDisplacement(shape[e], e, { g.x, 0 }, xx);
			addRelativeDisplacement(shape[e], e, { 0, g.y }, yy);
			addRelativeDisplacement(shape[e], e, { g.y, g.x }, xy);
			b.row(0) += xx;
			b.row(1) += yy;
			b.row(2) += xy;
		}
		if (rotation == RotationTreatment::Corotational)
			for (int e = 0; e < 3; e++) {
				b.col(2 * e) += gradient[e].x * b.col(rotationPlace);
				b.col(2 * e + 1) += gradient[e].y * b.col(rotationPlace);
			}
		if (rotation != RotationTreatment::Cosserat) b.col(rotationPlace).setZero(); // no unknown there
		matrix += 0.5 * twice * thickness * b.transpose() * moduli * b;
	}
	if (rotation == RotationTreatment::Cosserat) {
		Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(9);
		for (int e = 0; e < 3; e++)
			addRelativeDisplacement(shape[e], e, (1. / 3) * rotationGradient(reference.arm[e]), row);
		matrix += reference.area() * thickness * stiffness.shear * stiffness.rotationStiffness * row.transpose()
		        * row;
	}
	return matrix;
}

ElementVector elementMass(const LumpedMass& mass)
{
	ElementVector diagonal;
	diagonal << mass.vertex, mass.vertex, mass.vertex, mass.vertex, mass.vertex, mass.vertex, mass.core, mass.core,
	        mass.inertia;
	return diagonal;
}

double highestFrequency(
        const TriangleReference<double>&     reference,
        const TriangleStiffness&             stiffness,
        double                               thickness,
        const LumpedMass&                    mass,
        RotationTreatment                    rotation,
        const RelativeDisplacements<double>& du)
{
	ElementMatrix matrix  = elementStiffness(reference, stiffness, thickness, rotation, du);
	ElementVector inverse = elementMass(mass).cwiseInverse().cwiseSqrt();
	if (rotation != RotationTreatment::Cosserat) inverse[rotationPlace] = 0; // no unknown there
	matrix = inverse.asDiagonal() * matrix * inverse.asDiagonal();
	const Eigen::SelfAdjointEigenSolver<ElementMatrix> solver(matrix, Eigen::EigenvaluesOnly);
	return std::sqrt(std::max(0., solver.eigenvalues().maxCoeff()));
}

double frequencyGrowth(
        const TriangleReference<double>&     reference,
        const TriangleStiffness&             stiffness,
        double                               thickness,
        const LumpedMass&                    mass,
        RotationTreatment                    rotation,
        const RelativeDisplacements<double>& du)
{
	if (rotation == RotationTreatment::None) return 0;
	const RelativeDisplacements<double> turn   = { turned(du[0]), turned(du[1]), turned(du[2]) };
	double                              energy = 0; // twice that of these displacements
	for (const auto& strain : subElementStrains(reference, turn))
		energy += reference.twiceSubArea()
		        * energyDensity(elasticStress(strain, lambda(stiffness), stiffness.shear), strain);
	double mobility = 0; // Σ of squared angle per unit momentum
	if (rotation == RotationTreatment::Cosserat) {
		const double strain = rotationStrain(reference, turn);
		energy += reference.area() * stiffness.shear * stiffness.rotationStiffness * strain * strain;
		mobility = 1 / mass.inertia;
	} else
		for (const auto& a : frameGradient(reference, shapeOf(reference, du)))
			mobility += dot(a, a) / mass.vertex;
	return std::sqrt(thickness * energy * mobility);
}

} // namespace yade::ddem
