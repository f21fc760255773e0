// GPL v2 or later, see LICENSE.
#include <pkg/ddem/kernel/algebra/Parameters.hpp>

#include <sstream>
#include <stdexcept>

namespace yade::ddem {

bool Bounds::allow(double value) const
{
	return (includesLeast ? value >= least : value > least) && (includesMost ? value <= most : value < most);
}

std::string Bounds::words() const
{
	std::ostringstream text;
	text << (includesLeast ? "at least " : "above ") << least;
	if (most < unbounded) text << " and " << (includesMost ? "at most " : "below ") << most;
	return text.str();
}

void checkParameters(const char* law, const std::vector<ParameterEntry>& entries, const void* parameters)
{
	for (const ParameterEntry& p : entries) {
		const double value = p.get(parameters);
		if (p.bounds.allow(value)) continue;
		std::ostringstream message;
		const std::string  unit = p.unit == std::string("-") ? "[-]" : p.unit;
		message << law << ": " << p.name << " = " << value << " " << unit << " is not allowed; it must be "
		        << p.bounds.words() << ". " << p.wayOut;
		throw std::invalid_argument(message.str());
	}
}

std::vector<ParameterEntry>
joined(const std::vector<ParameterEntry>& base, const std::vector<ParameterEntry>& own, const void* sample)
{
	std::vector<ParameterEntry> all = base;
	all.insert(all.end(), own.begin(), own.end());
	for (ParameterEntry& p : all)
		p.standard = p.get(sample);
	return all;
}

} // namespace yade::ddem
