// GPL v2 or later, see LICENSE.
// Loose triangles whose strains a test prescribes, and what their law makes of them.
#pragma once

#include "TriangleSamples.hpp"

#include <functional>
#include <string>
#include <vector>

namespace yade::ddem::samples {

constexpr unsigned everything = ConcreteEffects::All & ~unsigned(ConcreteEffects::Energy);

/// Loose triangles about 5 mm wide within 0.3 m of the origin, whose strains are prescribed.
struct Loose {
	using Strain = std::function<PlaneTensor(std::size_t triangle)>;

	Mesh           mesh;
	TriangleSystem system;
	double         largestStep = 0; ///< largest change of a strain component in a step so far [-]

	template <class Law> static Loose of(std::size_t count, unsigned mask, std::size_t first = 0)
	{
		Loose  sample;
		Random random(31);
		for (std::size_t i = 0; i < first + count; i++) {
			const Vertices v { { { 0, 0 }, { 5e-3, 1e-3 }, { 2e-3, 4e-3 } } };
			const Point    place { i < first ? 0.2 : random.uniform(-0.3, 0.3),
                                            i < first ? 0.1 : random.uniform(-0.3, 0.3) };
			for (const Point& corner : v)
				sample.mesh.node.push_back(place + corner);
			const auto n = std::int32_t(3 * i);
			sample.mesh.triangle.push_back({ n, n + 1, n + 2 });
		}
		sample.system = makeSystem(sample.mesh, Material(), RotationTreatment::Cosserat);
		setGroups<Law>(sample.system, Material(), typename Law::Parameters(), mask, { first + count });
		for (Points* points : { &sample.system.motion.node, &sample.system.motion.core })
			std::fill(points->inverseMass.begin(), points->inverseMass.end(), 0.);
		std::fill(
		        sample.system.motion.spin.inverseInertia.begin(),
		        sample.system.motion.spin.inverseInertia.end(),
		        0.);
		sample.system.motion.collectConstraints();
		return sample;
	}
	static Loose concrete(std::size_t count, unsigned mask = everything, std::size_t first = 0)
	{
		return of<ConcreteDamage>(count, mask, first);
	}
	LawGroup& group() { return *system.group[0]; }

	void place(const Strain& strainOf)
	{
		for (std::size_t i = 0; i < mesh.triangle.size(); i++) {
			const PlaneTensor s      = strainOf(i);
			const Point       centre = centroid(mesh.corners(i));
			const auto        moved  = [&](const Point& x) {
                                const Point r = x - centre;
                                return centre + Point { s.xx * r.x + s.xy * r.y, s.xy * r.x + s.yy * r.y } + r;
			};
			for (const std::int32_t v : mesh.triangle[i]) {
				const Point x                                       = moved(mesh.node[std::size_t(v)]);
				system.motion.node.position[2 * std::size_t(v)]     = x.x;
				system.motion.node.position[2 * std::size_t(v) + 1] = x.y;
			}
			system.motion.core.position[2 * i]     = centre.x;
			system.motion.core.position[2 * i + 1] = centre.y;
		}
	}
	StepEnergy step(const Strain& strainOf, double dt, bool energy = false)
	{
		place(strainOf);
		return system.step(stepOf(dt, energy));
	}
	std::vector<double> values(const std::string& name, std::size_t triangle, std::size_t k) const
	{
		const LawGroup&     g = *system.group[0];
		const StateField*   f = g.field(name);
		std::vector<double> v(f->components());
		g.get(*f, triangle, k, v.data());
		return v;
	}
	PlaneTensor tensor(const std::string& name, std::size_t triangle, std::size_t k) const
	{
		const auto v = values(name, triangle, k);
		return v.size() == 3 ? PlaneTensor { v[0], v[1], 0, v[2] } : PlaneTensor { v[0], v[1], v[2], v[3] };
	}
	/// All forces on the corners and the core of a triangle, and its state.
	std::vector<double> outputs(std::size_t row) const
	{
		std::vector<double> all;
		const Motion&       m = system.motion;
		for (std::size_t c = 0; c < 6; c++)
			all.push_back(m.node.force[6 * row + c]);
		all.insert(all.end(), { m.core.force[2 * row], m.core.force[2 * row + 1], m.spin.moment[row] });
		for (const StateField& f : system.group[0]->fields())
			for (std::size_t k = 0; k < 3; k++)
				for (const double v : values(f.name, row, k))
					all.push_back(v);
		return all;
	}
	/// Stress in the triangle as its forces tell [Pa]: Σ x ⊗ f over the corners, without the rotation part.
	PlaneTensor meanStress(std::size_t i) const
	{
		double      xx = 0, yy = 0, xy = 0;
		const auto& m      = system.motion;
		const Point centre = { m.core.position[2 * i], m.core.position[2 * i + 1] };
		for (std::size_t v = 3 * i; v < 3 * i + 3; v++) {
			const Point r { m.node.position[2 * v] - centre.x, m.node.position[2 * v + 1] - centre.y };
			xx -= r.x * m.node.force[2 * v];
			yy -= r.y * m.node.force[2 * v + 1];
			xy -= 0.5 * (r.x * m.node.force[2 * v + 1] + r.y * m.node.force[2 * v]);
		}
		const double volume = system.topology.reference(i).area();
		return { xx / volume, yy / volume, 0, xy / volume };
	}
};

/// Compression with shear that differs from triangle to triangle.
inline PlaneTensor crushing(double t, std::size_t i)
{
	const double share = double(i % 17) / 17;
	return { 0.3 * t * share, -t, 0, 0.3 * t * (1 - share) };
}

} // namespace yade::ddem::samples
