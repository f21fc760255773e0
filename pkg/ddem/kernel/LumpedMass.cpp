// GPL v2 or later, see LICENSE.
#include <pkg/ddem/kernel/LumpedMass.hpp>

#include <stdexcept>
#include <string>

namespace yade::ddem {

LumpedMass lumpMass(const TriangleReference<double>& reference, double density, double thickness, double vertexShare, RotationTreatment rotation)
{
	if (!(density > 0)) throw std::invalid_argument("density = " + std::to_string(density) + " kg/m³ must be positive");
	if (!(thickness > 0)) throw std::invalid_argument("thickness = " + std::to_string(thickness) + " m must be positive");
	const bool   rotates = rotation == RotationTreatment::Cosserat;
	const double limit   = rotates ? 0.25 : 1.;
	if (!(vertexShare > 0 && vertexShare < limit))
		throw std::invalid_argument(
		        "vertexShare = " + std::to_string(vertexShare) + " (mass share of the vertices) must lie between 0 and " + (rotates ? "1/4 where cores rotate: above it no inertia is left for the core" : "1"));
	const double mass = density * reference.area() * thickness;
	double       arms = 0;
	for (const auto& r : reference.arm)
		arms += dot(r, r);
	return { vertexShare * mass / 3, (1 - vertexShare) * mass, mass * arms * (1. / 12 - vertexShare / 3) };
}

} // namespace yade::ddem
