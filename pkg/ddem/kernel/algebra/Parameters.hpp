// GPL v2 or later, see LICENSE.
// Parameters of a law, written once: a list gives member, default, unit, bounds, way out and doc string.
//
// A list is a macro that calls P once for every parameter:
//
//     P(strength, 3e6, "Pa", above(0), "Concrete has 2e6 to 5e6 Pa.", "Strength in tension.")
//
// and a law's Parameters take their members and their table from it:
//
//     struct Parameters : ElasticParameters {
//             MY_LAW_PARAMETERS(DDEM_MEMBER)
//             DDEM_ENTRIES(Parameters, ElasticParameters, MY_LAW_PARAMETERS)
//     };
//
// The material makes YADE attributes of the same list, the material point its names, tests and manual their tables.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace yade::ddem {

/// Values that a parameter may have.
struct Bounds {
	double least, most;
	bool   includesLeast, includesMost;

	bool        allow(double value) const; ///< a NaN is never allowed
	std::string words() const;             ///< "at least 0 and below 1"
};

constexpr double unbounded = std::numeric_limits<double>::max();
constexpr Bounds above(double least) { return { least, unbounded, false, true }; }
constexpr Bounds aboveOrInfinite(double least)
{
	return { least, std::numeric_limits<double>::infinity(), false, true };
}
constexpr Bounds aboveAtMost(double least, double most) { return { least, most, false, true }; }
constexpr Bounds atLeast(double least) { return { least, unbounded, true, true }; }
constexpr Bounds between(double least, double most) { return { least, most, true, true }; }           ///< ends included
constexpr Bounds strictlyBetween(double least, double most) { return { least, most, false, false }; } ///< ends excluded
/// least included
constexpr Bounds fromBelow(double least, double most) { return { least, most, true, false }; }

/// What is known of a parameter.
struct ParameterEntry {
	const char* name;
	double      standard; ///< default
	const char* unit;     ///< "[-]" has the unit "-"
	Bounds      bounds;
	const char* wayOut; ///< a sentence for who broke the bounds
	const char* doc;
	std::size_t offset; ///< of the member in the law's Parameters [bytes]

	double get(const void* parameters) const
	{
		return *reinterpret_cast<const double*>(static_cast<const char*>(parameters) + offset);
	}
	void set(void* parameters, double value) const
	{
		*reinterpret_cast<double*>(static_cast<char*>(parameters) + offset) = value;
	}
};

/// \throws std::invalid_argument naming the law, the parameter, its value, its unit and the way out.
void checkParameters(const char* law, const std::vector<ParameterEntry>& entries, const void* parameters);

#define DDEM_MEMBER(name, standard, unit, bounds, wayOut, doc) double name = standard; ///< see the list
#define DDEM_ENTRY(name, standard, unit, bounds, wayOut, doc) \
	ParameterEntry { #name, standard, unit, bounds, wayOut, doc, offsetOf(&Self::name) },
/// Declares entries(): those of the base class and of the list.
#define DDEM_ENTRIES(Class, Base, LIST) \
	static const std::vector<ParameterEntry>& entries() \
	{ \
		using Self = Class; \
		static const auto sample = Self(); \
		const auto offsetOf = [](double Self::*member) { \
			return std::size_t( \
			        reinterpret_cast<const char*>(&(sample.*member)) \
			        - reinterpret_cast<const char*>(&sample)); \
		}; \
		static const std::vector<ParameterEntry> all = joined(Base::entries(), { LIST(DDEM_ENTRY) }, &sample); \
		return all; \
	}

/// Both lists; defaults are those of `sample`, since a law may change those of its base.
std::vector<ParameterEntry>
joined(const std::vector<ParameterEntry>& base, const std::vector<ParameterEntry>& own, const void* sample);

/// Parameters that every law of a deformable triangle has.
#define ELASTIC_PARAMETERS(P) \
	P(bulk, 30e9, "Pa", above(0), "Concrete has about 30e9 Pa, steel 1.6e11 Pa.", \
	  "Bulk modulus B at zero pressure.") \
	P(shear, 26e9, "Pa", above(0), "Concrete has about 26e9 Pa, steel 8e10 Pa.", \
	  "Shear modulus μ at zero pressure.") \
	P(rotationStiffness, 2, "-", atLeast(0), "0 leaves rotations free, Zubelewicz (2018) uses 2.", \
	  "Stiffness β_φ of the rotation strain, as a multiple of the shear modulus.") \
	P(density, 2400, "kg/m³", above(0), "Concrete has about 2400 kg/m³.", "Mass density ρ.")

struct NoParameters {
	static const std::vector<ParameterEntry>& entries()
	{
		static const std::vector<ParameterEntry> none;
		return none;
	}
};

struct ElasticParameters {
	ELASTIC_PARAMETERS(DDEM_MEMBER)
	DDEM_ENTRIES(ElasticParameters, NoParameters, ELASTIC_PARAMETERS)
};

} // namespace yade::ddem
