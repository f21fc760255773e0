// GPL v2 or later, see LICENSE.
// Triangles, meshes and systems that the tests of the deformable triangles share.
#pragma once

#include <pkg/ddem/kernel/laws/ConcreteDamage.hpp>
#include <pkg/ddem/kernel/laws/Elastic.hpp>
#include <pkg/ddem/kernel/triangles/ElementFrame.hpp>
#include <pkg/ddem/kernel/triangles/StableStep.hpp>
#include <pkg/ddem/kernel/triangles/TriangleSystem.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace yade::ddem::samples {

using Point    = PlaneVector<double>;
using Vertices = std::array<Point, 3>;

constexpr RotationTreatment allTreatments[]
        = { RotationTreatment::None, RotationTreatment::Corotational, RotationTreatment::Cosserat };

inline std::string name(RotationTreatment rotation)
{
	return rotation == RotationTreatment::None            ? "None"
	        : rotation == RotationTreatment::Corotational ? "Corotational"
	                                                      : "Cosserat";
}

/// Elastic material of a test; the defaults are the concrete of Zubelewicz (2018), Table 1.
struct Material {
	double bulk = 30e9, shear = 26e9; ///< [Pa]
	double rotationStiffness = 2;     ///< β_φ [-]
	double density           = 2400;  ///< [kg/m³]
	double thickness         = 1;     ///< [m]
	double vertexShare       = 1. / 6;

	double            lambda() const { return bulk - 2. / 3 * shear; }
	TriangleStiffness stiffness() const { return { bulk, shear, rotationStiffness }; }
	LumpedMass        mass(const TriangleReference<double>& reference, RotationTreatment rotation) const
	{
		return lumpMass(reference, density, thickness, vertexShare, rotation);
	}
};

/// Numbers that are the same on every machine (the standard's distributions need not be).
class Random {
public:
	explicit Random(std::uint64_t seed)
	        : engine(seed)
	{
	}
	double uniform(double from, double to) { return from + (to - from) * double(engine() >> 11) * 0x1p-53; }
	Point  point(double size) { return { uniform(-size, size), uniform(-size, size) }; }
	/// Counter-clockwise triangle of any shape down to a height of 1/20 of its longest edge,
	/// 1 mm to `widest` [m] across.
	Vertices skewedTriangle(double widest = 10)
	{
		const double size = std::pow(10., uniform(-3, std::log10(widest)));
		for (;;) {
			Vertices     v       = { point(size), point(size), point(size) };
			const double area2   = cross(v[1] - v[0], v[2] - v[0]);
			double       longest = 0;
			for (std::size_t e = 0; e < 3; e++) {
				const Point edge = v[(e + 1) % 3] - v[e];
				longest          = std::max(longest, std::hypot(edge.x, edge.y));
			}
			if (std::abs(area2) < 0.05 * longest * longest || longest < 0.5 * size) continue;
			if (area2 < 0) std::swap(v[1], v[2]);
			return v;
		}
	}
	template <class List> void shuffle(List& list) // Fisher–Yates
	{
		for (std::size_t i = list.size(); i > 1; i--)
			std::swap(list[i - 1], list[std::size_t(engine() % i)]);
	}

private:
	std::mt19937_64 engine;
};

struct Mesh {
	std::vector<Point>                       node;
	std::vector<std::array<std::int32_t, 3>> triangle;

	Vertices corners(std::size_t i) const
	{
		const auto& t = triangle[i];
		return { node[std::size_t(t[0])], node[std::size_t(t[1])], node[std::size_t(t[2])] };
	}
};

/// Rectangle [0, width] × [0, height] of cells cut by alternating diagonals;
/// inner and outer nodes are moved by up to `jitter` of a cell.
inline Mesh rectangle(int columns, int rows, double width, double height, double jitter = 0, std::uint64_t seed = 1)
{
	Random       random(seed);
	const double dx = width / columns, dy = height / rows;
	Mesh         mesh;
	for (int j = 0; j <= rows; j++)
		for (int i = 0; i <= columns; i++)
			mesh.node.push_back({ (i + jitter * random.uniform(-1, 1)) * dx,
			                      (j + jitter * random.uniform(-1, 1)) * dy });
	for (int j = 0; j < rows; j++)
		for (int i = 0; i < columns; i++) {
			const std::int32_t a = j * (columns + 1) + i, b = a + 1, d = a + columns + 1, c = d + 1;
			if ((i + j) % 2) {
				mesh.triangle.push_back({ a, b, d });
				mesh.triangle.push_back({ b, c, d });
			} else {
				mesh.triangle.push_back({ a, b, c });
				mesh.triangle.push_back({ a, c, d });
			}
		}
	return mesh;
}

inline Mesh single(const Vertices& v) { return { { v[0], v[1], v[2] }, { { 0, 1, 2 } } }; }

/// Virgin groups of one law that end at the given rows, with the elasticity of the material.
template <class Law>
inline void setGroups(
        TriangleSystem&                 system,
        const Material&                 material,
        typename Law::Parameters        parameters,
        unsigned                        effects,
        const std::vector<std::size_t>& ends,
        TriangleProperties              properties = TriangleProperties())
{
	parameters.bulk              = material.bulk;
	parameters.shear             = material.shear;
	parameters.rotationStiffness = material.rotationStiffness;
	parameters.density           = material.density;
	system.group.clear();
	std::size_t begin = 0;
	for (const std::size_t end : ends) {
		auto group                       = makeGroup<Law>(parameters, effects);
		group->begin                     = begin;
		group->end                       = end;
		group->constants.thickness       = material.thickness;
		group->constants.rotationModulus = material.shear * material.rotationStiffness;
		std::vector<TriangleProperties> all;
		for (std::size_t i = begin; i < end; i++) {
			all.push_back(properties);
			all.back().area = system.topology.reference(i).area();
		}
		group->start(all);
		system.group.emplace_back(std::move(group));
		begin = end;
	}
	system.build();
}

/// Elastic system of one group, at rest and without stress.
inline TriangleSystem makeSystem(const Mesh& mesh, const Material& material, RotationTreatment rotation)
{
	TriangleSystem    system;
	const std::size_t n = mesh.triangle.size();
	system.rotation     = rotation;
	system.motion.node.resize(mesh.node.size());
	system.motion.core.resize(n);
	if (rotation == RotationTreatment::Cosserat) system.motion.spin.resize(n);
	for (std::size_t i = 0; i < n; i++) {
		const Vertices   corners   = mesh.corners(i);
		const auto       reference = makeReference(corners);
		const LumpedMass mass      = material.mass(reference, rotation);
		const Point      centre    = centroid(corners);
		system.topology.addTriangle(mesh.triangle[i], reference);
		system.motion.core.position[2 * i]     = centre.x;
		system.motion.core.position[2 * i + 1] = centre.y;
		system.motion.core.mass[i]             = mass.core;
		for (const std::int32_t v : mesh.triangle[i])
			system.motion.node.mass[std::size_t(v)] += mass.vertex;
		if (rotation == RotationTreatment::Cosserat) {
			system.motion.spin.inertia[i]        = mass.inertia;
			system.motion.spin.inverseInertia[i] = 1 / mass.inertia;
		}
	}
	for (std::size_t v = 0; v < mesh.node.size(); v++) {
		system.motion.node.position[2 * v]     = mesh.node[v].x;
		system.motion.node.position[2 * v + 1] = mesh.node[v].y;
	}
	for (Points* points : { &system.motion.node, &system.motion.core })
		for (std::size_t i = 0; i < points->inverseMass.size(); i++)
			points->inverseMass[i] = 1 / points->mass[i / 2];
	setGroups<Elastic>(system, material, ElasticParameters(), 0, { n });
	return system;
}

/// Turns a system of one group into one of undamaged concrete with the given mask of ConcreteEffects.
inline void makeConcrete(TriangleSystem& system, const ConcreteParameters& parameters, unsigned effects)
{
	setGroups<ConcreteDamage>(system, Material(), parameters, effects, { system.triangles() });
}

/// Largest step [s] that the bound over all elements allows.
inline double criticalStep(const Mesh& mesh, const Material& material, RotationTreatment rotation)
{
	double highest = 0;
	for (std::size_t i = 0; i < mesh.triangle.size(); i++) {
		const auto reference = makeReference(mesh.corners(i));
		highest = std::max(
		        highest,
		        highestFrequency(
		                reference, material.stiffness(), material.thickness, material.mass(reference, rotation),
		                rotation));
	}
	return 2 / highest;
}

/// Random velocities of nodes and cores up to `speed` [m/s], and of cores' rotations up to `spin` [rad/s].
inline void agitate(TriangleSystem& system, double speed, double spin, std::uint64_t seed)
{
	Random random(seed);
	for (auto* velocity : { &system.motion.node.velocity, &system.motion.core.velocity })
		for (double& v : *velocity)
			v = random.uniform(-speed, speed);
	for (double& w : system.motion.spin.velocity)
		w = random.uniform(-spin, spin);
}

inline StepSettings stepOf(double dt, bool energy = false)
{
	StepSettings settings;
	settings.dt     = dt;
	settings.energy = energy;
	return settings;
}

inline StepEnergy run(TriangleSystem& system, const StepSettings& settings, int steps)
{
	StepEnergy last;
	for (int i = 0; i < steps; i++)
		last = system.step(settings);
	return last;
}

template <class List> inline double largest(const List& values)
{
	double result = 0;
	for (const double v : values)
		result = std::max(result, std::abs(v));
	return result;
}

template <class List> inline double largestDifference(const List& a, const List& b)
{
	double result = a.size() == b.size() ? 0 : INFINITY;
	for (std::size_t i = 0; i < std::min(a.size(), b.size()); i++)
		result = std::max(result, std::abs(a[i] - b[i]));
	return result;
}

} // namespace yade::ddem::samples
