// GPL v2 or later, see LICENSE.
// Element stiffness and the bound that it sets on the time step.
#include "../TriangleSamples.hpp"

#include <pkg/ddem/kernel/triangles/SystemStableStep.hpp>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SparseCore>

#include <gtest/gtest.h>

namespace {

using namespace yade::ddem;
using namespace yade::ddem::samples;

/// Stiffness and mass of a whole mesh; unknowns: nodes, then cores, then rotations of cores.
struct Assembly {
	Eigen::SparseMatrix<double> stiffness;
	Eigen::VectorXd             mass;

	Assembly(const Mesh& mesh, const std::vector<Material>& material, RotationTreatment rotation)
	{
		const auto nodes = Eigen::Index(mesh.node.size()), triangles = Eigen::Index(mesh.triangle.size());
		const auto                          unknowns = 2 * nodes + 3 * triangles;
		std::vector<Eigen::Triplet<double>> entries;
		mass = Eigen::VectorXd::Zero(unknowns);
		for (Eigen::Index i = 0; i < triangles; i++) {
			const Material&             m         = material[std::size_t(i) % material.size()];
			const auto                  reference = makeReference(mesh.corners(std::size_t(i)));
			const ElementMatrix k = elementStiffness(reference, m.stiffness(), m.thickness, rotation);
			const ElementVector         masses    = elementMass(m.mass(reference, rotation));
			std::array<Eigen::Index, 9> place;
			for (std::size_t e = 0; e < 3; e++)
				for (std::size_t c = 0; c < 2; c++)
					place[2 * e + c] = 2 * mesh.triangle[std::size_t(i)][e] + Eigen::Index(c);
			place[6] = 2 * nodes + 2 * i;
			place[7] = place[6] + 1;
			place[8] = 2 * nodes + 2 * triangles + i;
			for (int row = 0; row < 9; row++) {
				mass[place[std::size_t(row)]] += masses[row];
				for (int column = 0; column < 9; column++)
					entries.emplace_back(
					        place[std::size_t(row)], place[std::size_t(column)], k(row, column));
			}
		}
		// no stiffness, no motion there
		if (rotation != RotationTreatment::Cosserat) mass.tail(triangles).setOnes();
		stiffness.resize(unknowns, unknowns);
		stiffness.setFromTriplets(entries.begin(), entries.end());
	}
	Eigen::SparseMatrix<double> dynamic() const
	{
		const Eigen::VectorXd scale = mass.cwiseInverse().cwiseSqrt();
		return scale.asDiagonal() * stiffness * scale.asDiagonal();
	}
	double highestFrequency() const
	{
		const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(
		        Eigen::MatrixXd(dynamic()), Eigen::EigenvaluesOnly);
		return std::sqrt(solver.eigenvalues().maxCoeff());
	}
};

double bound(const Mesh& mesh, const std::vector<Material>& material, RotationTreatment rotation)
{
	double highest = 0;
	for (std::size_t i = 0; i < mesh.triangle.size(); i++) {
		const Material& m         = material[i % material.size()];
		const auto      reference = makeReference(mesh.corners(i));
		highest = std::max(
		        highest,
		        highestFrequency(reference, m.stiffness(), m.thickness, m.mass(reference, rotation), rotation));
	}
	return highest;
}

Eigen::VectorXd
eigenvaluesPerMass(const TriangleReference<double>& reference, const Material& m, RotationTreatment rotation)
{
	const ElementVector scale
	        = elementMass(m.mass(reference, RotationTreatment::Cosserat)).cwiseInverse().cwiseSqrt();
	const ElementMatrix k = scale.asDiagonal() * elementStiffness(reference, m.stiffness(), m.thickness, rotation)
	        * scale.asDiagonal();
	return Eigen::SelfAdjointEigenSolver<ElementMatrix>(k, Eigen::EigenvaluesOnly).eigenvalues();
}

TEST(ElementStiffness, resistsEverythingButRigidMotion)
{
	Random random(31);
	for (int i = 0; i < 200; i++) {
		const auto      reference = makeReference(random.skewedTriangle());
		const Material  material;
		Eigen::VectorXd values = eigenvaluesPerMass(reference, material, RotationTreatment::Cosserat);
		values /= values[8];
		for (int j = 0; j < 3; j++) // two translations, one rotation of vertices and core together
			EXPECT_NEAR(values[j], 0, 1e-13);
		EXPECT_GT(values[3], 1e-5);

		Material free;
		free.rotationStiffness = 0; // the core turns freely
		values                 = eigenvaluesPerMass(reference, free, RotationTreatment::Cosserat);
		values /= values[8];
		EXPECT_NEAR(values[3], 0, 1e-13);
		EXPECT_GT(values[4], 1e-5);

		values = eigenvaluesPerMass(reference, material, RotationTreatment::None);
		values /= values[8];
		EXPECT_NEAR(values[3], 0, 1e-13); // the unknown that is not there
		EXPECT_GT(values[4], 1e-5);
	}
}

TEST(ElementStiffness, isSymmetric)
{
	Random random(32);
	for (int i = 0; i < 20; i++)
		for (const auto rotation : allTreatments) {
			const ElementMatrix k = elementStiffness(
			        makeReference(random.skewedTriangle()), { 3, 2, 1.5 }, 0.4, rotation);
			EXPECT_LT((k - k.transpose()).cwiseAbs().maxCoeff(), 1e-14 * k.cwiseAbs().maxCoeff());
		}
}

// 48 skewed triangles, soft and stiff, light and heavy side by side
TEST(FrequencyBound, isAboveTheHighestFrequencyOfAnyMesh)
{
	for (std::uint64_t seed = 1; seed <= 8; seed++)
		for (const auto rotation : allTreatments) {
			const Mesh            mesh = rectangle(4, 6, 0.1, 0.2, 0.2, seed);
			Random                random(seed);
			std::vector<Material> material(mesh.triangle.size());
			for (Material& m : material) {
				m.bulk *= std::pow(10., random.uniform(-1, 1));
				m.shear *= std::pow(10., random.uniform(-1, 1));
				m.density *= random.uniform(0.3, 3);
				m.rotationStiffness = random.uniform(0, 4);
				m.vertexShare       = random.uniform(0.05, 0.24);
			}
			const double global = Assembly(mesh, material, rotation).highestFrequency(),
			             limit  = bound(mesh, material, rotation);
			EXPECT_LE(global, limit * (1 + 1e-12)) << name(rotation) << ", seed " << seed;
			// such contrasts cost at most a factor of 5
			EXPECT_GT(global, 0.2 * limit) << name(rotation) << ", seed " << seed;
		}
}

TEST(FrequencyBound, isTheFrequencyOfAFreeTriangle)
{
	Random random(33);
	for (int i = 0; i < 50; i++)
		for (const auto rotation : allTreatments) {
			const Mesh   mesh   = single(random.skewedTriangle());
			const double global = Assembly(mesh, { Material() }, rotation).highestFrequency();
			EXPECT_NEAR(bound(mesh, { Material() }, rotation), global, 1e-12 * global);
		}
}

TEST(FrequencyBound, holdsForSharesThatLeaveACoreNoInertia) // a quarter and more is allowed where cores do not rotate
{
	const Mesh mesh = rectangle(4, 6, 0.1, 0.2, 0.2, 3);
	for (const auto rotation : { RotationTreatment::None, RotationTreatment::Corotational })
		for (const double share : { 0.25, 0.5, 0.9 }) {
			Material m;
			m.vertexShare       = share;
			const double global = Assembly(mesh, { m }, rotation).highestFrequency(),
			             limit  = bound(mesh, { m }, rotation);
			EXPECT_LE(global, limit * (1 + 1e-12)) << name(rotation) << ", share " << share;
			EXPECT_GT(global, 0.7 * limit) << name(rotation) << ", share " << share;
		}
}

TEST(FrequencyBound, isTightOnAMeshOfEqualTriangles) // it costs at most 10 % of the step where all elements are alike
{
	for (const auto rotation : allTreatments) {
		const Mesh   mesh   = rectangle(6, 6, 0.06, 0.06);
		const double global = Assembly(mesh, { Material() }, rotation).highestFrequency(),
		             limit  = bound(mesh, { Material() }, rotation);
		EXPECT_GT(global, 0.9 * limit) << name(rotation);
		EXPECT_LE(global, limit * (1 + 1e-12)) << name(rotation);
	}
}

TEST(FrequencyBound, scalesWithSizeAndWaveSpeed) // ω ∝ √(E/ρ)/size, whatever the thickness
{
	const Vertices v     = { { { 0, 0 }, { 2, 0.3 }, { 0.4, 1.1 } } },
	               twice = { { { 0, 0 }, { 4, 0.6 }, { 0.8, 2.2 } } };
	for (const auto rotation : allTreatments) {
		const auto frequency
		        = [&](const Vertices& x, const Material& m) { return bound(single(x), { m }, rotation); };
		const double once      = frequency(v, Material());
		EXPECT_NEAR(frequency(twice, Material()), once / 2, 1e-12 * once);
		EXPECT_NEAR(frequency(v, { 4 * 30e9, 4 * 26e9, 2, 2400, 1, 1. / 6 }), 2 * once, 1e-12 * once);
		EXPECT_NEAR(frequency(v, { 30e9, 26e9, 2, 4 * 2400, 1, 1. / 6 }), once / 2, 1e-12 * once);
		EXPECT_NEAR(frequency(v, { 30e9, 26e9, 2, 2400, 0.01, 1. / 6 }), once, 1e-12 * once);
	}
}

/// 2/ω [s] of a whole mesh by Lanczos' iteration without reorthogonalisation (its largest Ritz value is reliable).
double globalStep(const Assembly& assembly)
{
	const Eigen::SparseMatrix<double> matrix = assembly.dynamic();
	constexpr int                     steps  = 150;
	Random                            random(34);
	Eigen::VectorXd                   old = Eigen::VectorXd::Zero(matrix.rows()), now(matrix.rows());
	for (double& v : now)
		v = random.uniform(-1, 1);
	now.normalize();
	Eigen::VectorXd diagonal(steps), side(steps);
	double          last = 0;
	for (int j = 0; j < steps; j++) {
		Eigen::VectorXd next = matrix * now - last * old;
		diagonal[j]          = next.dot(now);
		next -= diagonal[j] * now;
		side[j] = last = next.norm();
		old            = now;
		now            = next / last;
	}
	Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
	solver.computeFromTridiagonal(diagonal, side.head(steps - 1), Eigen::EigenvaluesOnly);
	return 2 / std::sqrt(solver.eigenvalues().maxCoeff());
}

// numbers: independent numpy element, dense eigenvalues; concrete, 0.1 m × 0.2 m, cells of 10 mm, in µs
TEST(GlobalStep, againstTheShareOfTheVertices)
{
	const Mesh mesh = rectangle(10, 20, 0.1, 0.2);
	struct Row {
		double share, step;
	};
	for (const auto& [share, step] : { Row { 0.05, 0.2870 },
	                                   { 1. / 12, 0.3636 },
	                                   { 1. / 8, 0.4344 },
	                                   { 1. / 6, 0.4880 },
	                                   { 0.2, 0.5174 },
	                                   { 0.24, 0.2821 } }) {
		Material m;
		m.vertexShare = share;
		EXPECT_NEAR(globalStep(Assembly(mesh, { m }, RotationTreatment::Cosserat)) * 1e6, step, 0.6e-4)
		        << "share " << share;
	}
	Material m; // without rotation the vertices may have more
	m.vertexShare = 0.5;
	EXPECT_NEAR(globalStep(Assembly(mesh, { m }, RotationTreatment::None)) * 1e6, 0.6481, 0.6e-4);
}

// no moment but its own acts on a core, so the core turns until ε_φ = 0
TEST(Statics, rotationStiffnessChangesNoStaticSolution)
{
	const Mesh      mesh  = rectangle(3, 4, 0.3, 0.4, 0.25, 7);
	const auto      nodes = Eigen::Index(mesh.node.size()), triangles = Eigen::Index(mesh.triangle.size());
	Random          random(35);
	Eigen::VectorXd load = Eigen::VectorXd::Zero(2 * nodes + 3 * triangles);
	for (Eigen::Index i = 0; i < 2 * nodes + 2 * triangles; i++)
		load[i] = random.uniform(-1e6, 1e6);
	const auto solve = [&](double rotationStiffness) {
		Material m;
		m.rotationStiffness = rotationStiffness;
		Eigen::MatrixXd matrix(Assembly(mesh, { m }, RotationTreatment::Cosserat).stiffness);
		// node 0 held, node 1 guided: no rigid motion
		for (const Eigen::Index fixed : { Eigen::Index(0), Eigen::Index(1), Eigen::Index(3) })
			matrix(fixed, fixed) *= 1e12;
		return Eigen::VectorXd(matrix.partialPivLu().solve(load));
	};
	const Eigen::VectorXd weak = solve(0.01), strong = solve(2);
	EXPECT_LT((weak - strong).cwiseAbs().maxCoeff(), 1e-8 * strong.cwiseAbs().maxCoeff());
}

// patch test of the pseudo-Cosserat medium: vertices held at a homogeneous strain, core free
TEST(Statics, coreTurnsByTheMeanTurnOfItsVertices)
{
	Random random(36);
	for (int i = 0; i < 200; i++) {
		const auto          reference = makeReference(random.skewedTriangle());
		const double        size      = std::sqrt(reference.area());
		const double        xx = random.uniform(-1, 1), yy = random.uniform(-1, 1), xy = random.uniform(-1, 1);
		const ElementMatrix k    = elementStiffness(reference, { 30, 26, 2 }, 1, RotationTreatment::Cosserat);
		ElementVector       u    = ElementVector::Zero();
		double              turn = 0;
		for (int e = 0; e < 3; e++) {
			const Point& r = reference.arm[std::size_t(e)];
			u[2 * e]       = xx * r.x + xy * r.y;
			u[2 * e + 1]   = xy * r.x + yy * r.y;
			turn += (r.x * u[2 * e + 1] - r.y * u[2 * e]) / dot(r, r) / 3; // angle by which the arm turns
		}
		Eigen::Vector3d units(1, 1, 1 / size);
		Eigen::Matrix3d core = units.asDiagonal() * k.bottomRightCorner<3, 3>() * units.asDiagonal();
		u.tail<3>() = -units.cwiseProduct(Eigen::Vector3d(
		        core.fullPivLu().solve(units.cwiseProduct(Eigen::Vector3d((k * u).tail<3>())))));
		EXPECT_NEAR(u[6], 0, 1e-12 * size);
		EXPECT_NEAR(u[7], 0, 1e-12 * size);
		EXPECT_NEAR(u[8], turn, 1e-12);
		// and then the forces on the vertices are those without rotation stiffness
		const ElementMatrix plain = elementStiffness(reference, { 30, 26, 0 }, 1, RotationTreatment::Cosserat);
		EXPECT_LT(
		        ((k - plain) * u).head<6>().cwiseAbs().maxCoeff(),
		        1e-12 * (plain * u).head<6>().cwiseAbs().maxCoeff());
	}
}

// ---- in a deformed shape --------------------------------------------------------------------------------------------

/// Displacement gradient without rotation, so that every frame stays where it is; stretches between 0.4 and 4.
struct Stretch {
	double xx, yy, xy;

	RelativeDisplacements<double> of(const TriangleReference<double>& reference) const
	{
		RelativeDisplacements<double> du;
		for (std::size_t e = 0; e < 3; e++) {
			const Point& r = reference.arm[e];
			du[e]          = { xx * r.x + xy * r.y, xy * r.x + yy * r.y };
		}
		return du;
	}
};

Stretch randomStretch(Random& random)
{
	const double first  = std::exp(random.uniform(std::log(0.4), std::log(4.))),
	             second = std::exp(random.uniform(std::log(0.4), std::log(4.)));
	const double angle = random.uniform(0, M_PI), c = std::cos(angle), s = std::sin(angle);
	return { first * c * c + second * s * s - 1, first * s * s + second * c * c - 1, (first - second) * c * s };
}

Eigen::VectorXd frequenciesSquared(const ElementMatrix& stiffness, const LumpedMass& mass, RotationTreatment rotation)
{
	ElementVector scale = elementMass(mass).cwiseInverse().cwiseSqrt();
	if (rotation != RotationTreatment::Cosserat) scale[8] = 0;
	const ElementMatrix k = scale.asDiagonal() * stiffness * scale.asDiagonal();
	return Eigen::SelfAdjointEigenSolver<ElementMatrix>(k, Eigen::EigenvaluesOnly).eigenvalues();
}

/// ∂Δu/∂(unknowns) in the present shape, by central differences of what the element loops do.
template <class Frame>
Eigen::Matrix<double, 6, 9>
relativeDisplacementGradient(const TriangleReference<double>& reference, const RelativeDisplacements<double>& du)
{
	const double size = std::sqrt(reference.area());
	const auto   at   = [&](int unknown, double change) {
                RelativeDisplacements<double> fromCentre = du;
                double                        angle      = 0;
                for (std::size_t e = 0; e < 3; e++)
                        fromCentre[e] = fromCentre[e] + reference.arm[e];
                const Point along { unknown % 2 ? 0 : change * size, unknown % 2 ? change * size : 0 };
                if (unknown < 6)
                        fromCentre[std::size_t(unknown / 2)] = fromCentre[std::size_t(unknown / 2)] + along;
                else if (unknown < 8)
                        for (auto& d : fromCentre)
                                d = d - along;
                else
                        angle = change;
                const auto                  frame = Frame::rotation(reference, fromCentre, angle);
                Eigen::Matrix<double, 6, 1> result;
                for (int e = 0; e < 3; e++) {
			const Point own = relativeDisplacement(
			        frame, fromCentre[std::size_t(e)], reference.arm[std::size_t(e)]);
			result[2 * e]     = own.x;
                        result[2 * e + 1] = own.y;
                }
                return result;
	};
	constexpr double            h = 1e-5;
	Eigen::Matrix<double, 6, 9> gradient;
	for (int unknown = 0; unknown < 9; unknown++)
		gradient.col(unknown) = (at(unknown, h) - at(unknown, -h)) / (2 * h * (unknown < 8 ? size : 1));
	return gradient;
}

// Hessian in Δu between the derivatives of Δu: all but the geometric part
TEST(DeformedStiffness, isTheSecondDerivativeOfTheEnergy)
{
	Random random(41);
	for (int i = 0; i < 50; i++)
		for (const auto rotation : allTreatments) {
			const auto          reference = makeReference(random.skewedTriangle());
			const Material      material;
			const auto          du   = randomStretch(random).of(reference);
			const auto plain = rotation == RotationTreatment::Cosserat ? rotation : RotationTreatment::None;
			// at rest, of the vertices alone: Δu_e = u_e
			const Eigen::Matrix<double, 6, 6> hessian
			        = elementStiffness(reference, material.stiffness(), material.thickness, plain)
			                  .topLeftCorner<6, 6>();
			const auto gradient = rotation == RotationTreatment::None
			        ? relativeDisplacementGradient<FrameNone>(reference, du)
			        : rotation == RotationTreatment::Corotational
			        ? relativeDisplacementGradient<FrameCorotational>(reference, du)
			        : relativeDisplacementGradient<FrameCosserat>(reference, du);
			const ElementMatrix   expected = gradient.transpose() * hessian * gradient;
			const LumpedMass      mass     = material.mass(reference, rotation);
			const Eigen::VectorXd here = frequenciesSquared(
			        elementStiffness(reference, material.stiffness(), material.thickness, rotation, du),
			        mass, rotation);
			const Eigen::VectorXd there    = frequenciesSquared(expected, mass, rotation);
			// differences are exact to h² = 1e-10
			EXPECT_LT((here - there).cwiseAbs().maxCoeff(), 1e-8 * there[8]) << name(rotation);
		}
}

TEST(FrequencyGrowth, isNeverLessThanWhatTheFrequencyGrowsBy)
{
	Random random(42);
	double closest[2] = { 0, 0 };
	for (int i = 0; i < 2000; i++)
		for (const auto rotation : { RotationTreatment::Corotational, RotationTreatment::Cosserat }) {
			const auto       reference = makeReference(random.skewedTriangle());
			const Material   material;
			const LumpedMass mass = material.mass(reference, rotation);
			const auto       du   = randomStretch(random).of(reference);
			const auto own = [&](const RelativeDisplacements<double>& shape) {
				return highestFrequency(
				        reference, material.stiffness(), material.thickness, mass, rotation, shape);
			};
			const double rest = own({}), now = own(du),
			             growth = frequencyGrowth(
			                     reference, material.stiffness(), material.thickness, mass, rotation, du);
			EXPECT_LE(now, (rest + growth) * (1 + 1e-12)) << name(rotation);
			double& best = closest[rotation == RotationTreatment::Cosserat];
			best         = std::max(best, now / (rest + growth));
		}
	EXPECT_GT(closest[0], 0.7); // and is not just large
	EXPECT_GT(closest[1], 0.7);
	EXPECT_EQ(
	        frequencyGrowth(
	                makeReference({ { { 0, 0 }, { 2, 0 }, { 0, 1 } } }), { 3, 2, 1 }, 1, { 1, 1, 1 },
	                RotationTreatment::Cosserat, {}),
	        0);
}

/// A free triangle of flawless concrete that has flowed into another shape, so that it is free of stress there;
/// it trembles a little.
TriangleSystem
stretchedTriangle(const Vertices& corners, const Material& material, const Stretch& stretch, RotationTreatment rotation)
{
	TriangleSystem system = makeSystem(single(corners), material, rotation);
	// undamaged, but it may have flowed
	setGroups<ConcreteDamage>(system, material, ConcreteParameters(), ConcreteEffects::Damage, { 1 });
	const RelativeDisplacements<double> du = stretch.of(system.topology.reference(0));
	for (std::size_t e = 0; e < 3; e++) {
		const auto v = std::size_t(system.topology.vertex[e][0]);
		system.motion.node.position[2 * v] += du[e].x;
		system.motion.node.position[2 * v + 1] += du[e].y;
	}
	const double flowed[] = { stretch.xx, stretch.yy, 0, stretch.xy };
	for (std::size_t k = 0; k < 3; k++)
		system.group[0]->set(*system.group[0]->field("plasticStrain"), 0, k, flowed);
	system.group[0]->fillUp();
	agitate(system, 1e-9, 1e-9, 5);
	return system;
}

double loudestAfter(int steps, TriangleSystem system, double dt)
{
	run(system, stepOf(dt), steps);
	return std::max(largest(system.motion.node.velocity), largest(system.motion.spin.velocity) * 0.1);
}

TEST(StableStepOfASystem, isSharpForAStretchedTriangle) // leapfrog in the kernel's own element loops, no eigenproblem
{
	struct Case {
		RotationTreatment rotation;
		Stretch           stretch;
		double            rotationStiffness; // a stretch that is not the same in all directions strains it
	};
	const Vertices corners = { { { 0, 0 }, { 0.011, 0.001 }, { 0.004, 0.009 } } };
	for (const auto& [rotation, stretch, rotationStiffness] :
	     { Case { RotationTreatment::Corotational, { 2.5, 1.5, 0.3 }, 2 },
	       Case { RotationTreatment::Corotational, { 0.9, -0.5, 0.2 }, 2 },
	       Case { RotationTreatment::Cosserat, { 1.5, 1.5, 0 }, 2 },
	       Case { RotationTreatment::Cosserat, { -0.5, -0.5, 0 }, 2 },
	       Case { RotationTreatment::Cosserat, { 3, -0.5, 0.2 }, 0 } }) {
		Material material;
		material.rotationStiffness          = rotationStiffness;
		const auto                reference = makeReference(corners);
		const std::vector<double> rest { highestFrequency(
			reference, material.stiffness(), 1, material.mass(reference, rotation), rotation) };
		const TriangleSystem      system = stretchedTriangle(corners, material, stretch, rotation);
		const double              step   = stableStep(system, rest, material.vertexShare).step;
		EXPECT_LT(loudestAfter(3000, system, 0.99 * step), 1e-6) << name(rotation) << ", " << stretch.xx;
		// exp(2 acosh 1.01) = 1.33 in a step
		EXPECT_GT(loudestAfter(100, system, 1.01 * step), 1e-3) << name(rotation) << ", " << stretch.xx;
		if (stretch.xx == 3) {
			EXPECT_LT(step, 0.75 * 2 / rest[0]); // the bound at rest would not have done
		}
	}
}

TEST(StableStepOfASystem, atRestIsThatOfItsStiffestTriangle)
{
	for (const auto rotation : allTreatments) {
		const Mesh          mesh   = rectangle(4, 6, 0.1, 0.2, 0.2, 9);
		const Material      material;
		TriangleSystem      system = makeSystem(mesh, material, rotation);
		std::vector<double> rest;
		for (std::size_t i = 0; i < system.triangles(); i++)
			rest.push_back(highestFrequency(
			        system.topology.reference(i), material.stiffness(), material.thickness,
			        material.mass(system.topology.reference(i), rotation), rotation));
		const auto   found   = stableStep(system, rest, material.vertexShare);
		const auto   stiffest = std::max_element(rest.begin(), rest.end());
		EXPECT_NEAR(found.step, 2 / *stiffest, 1e-12 * found.step);
		EXPECT_EQ(found.triangle, std::size_t(stiffest - rest.begin()));
		// nothing to find below
		EXPECT_GE(stableStep(system, rest, material.vertexShare, 0.5 * found.step).step, 0.5 * found.step);
	}
}

TEST(StableStepOfASystem, findsTheOneStretchedTriangleAmongMany)
{
	const Mesh          mesh = rectangle(6, 6, 0.06, 0.06, 0.1, 4);
	const Material      material;
	TriangleSystem      system = makeSystem(mesh, material, RotationTreatment::Cosserat);
	std::vector<double> rest;
	double              expected = INFINITY;
	system.motion.node.position[2 * 24] += 0.02; // an inner node far away: six triangles are stretched or squeezed
	for (std::size_t i = 0; i < system.triangles(); i++) {
		const auto reference = system.topology.reference(i);
		const auto mass      = material.mass(reference, RotationTreatment::Cosserat);
		rest.push_back(highestFrequency(reference, material.stiffness(), 1, mass, RotationTreatment::Cosserat));
		expected = std::min(
		        expected,
		        2
		                / highestFrequency(
		                        reference, material.stiffness(), 1, mass, RotationTreatment::Cosserat,
		                        system.relativeDisplacements(i)));
	}
	const auto found = stableStep(system, rest, material.vertexShare);
	EXPECT_NEAR(found.step, expected, 1e-12 * expected);
	EXPECT_LT(found.step, 0.9 * 2 / *std::max_element(rest.begin(), rest.end()));
	EXPECT_EQ(stableStep(system, rest, material.vertexShare, 1.5 * expected).triangle, found.triangle);
}

} // namespace
