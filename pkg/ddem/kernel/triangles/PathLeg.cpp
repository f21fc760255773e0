// GPL v2 or later, see LICENSE.
#include <pkg/ddem/kernel/triangles/PathLeg.hpp>

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace yade::ddem {

namespace {
	constexpr const char* names[] = { "xx", "yy", "zz", "xy" };

	bool isFinite(const PlaneTensor& t)
	{
		return std::isfinite(t.xx) && std::isfinite(t.yy) && std::isfinite(t.zz) && std::isfinite(t.xy);
	}
}

void checkInitialDamage(const PlaneTensor& damage)
{
	const bool semiDefinite
	        = damage.xx >= 0 && damage.yy >= 0 && damage.zz >= 0 && damage.xx * damage.yy >= damage.xy * damage.xy;
	if (semiDefinite && isFinite(damage)) return;
	std::ostringstream message;
	message << "pre-existing damage (xx, yy, zz, xy) = (" << damage.xx << ", " << damage.yy << ", " << damage.zz
	        << ", " << damage.xy
	        << ") [-] must be finite and positive semi-definite: diagonal at least 0 and xy² at most xx yy.";
	throw std::invalid_argument(message.str());
}

void PathLeg::validate(std::size_t every) const
{
	if (!(std::isfinite(duration) && duration > 0))
		throw std::invalid_argument(
		        "path: duration must be a positive number of seconds, got " + std::to_string(duration) + " s.");
	if (steps == 0 || every == 0)
		throw std::invalid_argument("path: the number of steps and of steps per record must be at least 1.");
	if (!isFinite(target)) throw std::invalid_argument("path: a target is not a finite number.");
}

std::string PathLeg::notBorne(double time, const std::array<double, 4>& stress) const
{
	std::ostringstream message;
	message << "path: at " << time << " s no strain gives the prescribed stress of";
	for (std::size_t k = 0; k < 4; ++k)
		if (control[k] == Control::Stress) message << " " << names[k] << " = " << stress[k] << " Pa";
	message << "; the material bears less. Prescribe a strain there, or a smaller stress.";
	return message.str();
}

} // namespace yade::ddem
