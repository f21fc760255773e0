// GPL v2 or later, see LICENSE.
#include <pkg/ddem/kernel/triangles/LumpedMass.hpp>

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace yade::ddem {

namespace {

	void requirePositive(const char* name, double value, const char* unit)
	{
		if (std::isfinite(value) && value > 0) return;
		std::ostringstream text;
		text << name << " = " << value << " " << unit << " must be a positive number";
		throw std::invalid_argument(text.str());
	}

} // namespace

LumpedMass lumpMass(
        const TriangleReference<double>& reference, double density, double thickness, double vertexShare,
        RotationTreatment rotation)
{
	requirePositive("density", density, "kg/m³");
	requirePositive("thickness", thickness, "m");
	const bool   rotates = rotation == RotationTreatment::Cosserat;
	const double limit   = rotates ? 0.25 : 1.;
	if (!(vertexShare > 0 && vertexShare < limit)) {
		std::ostringstream text;
		text << "vertexShare = " << vertexShare
		     << " (share of the mass that goes to the vertices) must lie between 0 and "
		     << (rotates ? "1/4 where cores rotate: from there on no inertia is left for the core; 1/6 is a "
		                   "good choice"
		                 : "1");
		throw std::invalid_argument(text.str());
	}
	const double mass = density * reference.area() * thickness;
	double       arms = 0;
	for (const auto& r : reference.arm)
		arms += dot(r, r);
	return { vertexShare * mass / 3, (1 - vertexShare) * mass, mass * arms * (1. / 12 - vertexShare / 3) };
}

} // namespace yade::ddem
