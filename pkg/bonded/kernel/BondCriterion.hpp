// GPL v2 or later, see LICENSE.
// What a criterion of bonds owes: when a bond breaks, and what of its loads it bears before.
//
// A criterion is a header kernel/criteria/NAME.hpp with a struct NAME, which MohrCoulomb.hpp shows:
//
//     name                       as in error messages and saved scenes
//     Parameters                 made from a list, see Parameters.hpp
//     Strength<Number>           numbers that every bond keeps of them, and their names
//     Memory<Number>             numbers that every bond remembers, and their names, the energy that it has taken as
//                                "lost"; NoBondMemory where it has none
//     strengthOf(parameters, bond), scaled(parameters, factor), weaker(parameters, others), radius(parameters, bond)
//     advance(strength, memory, section, stiffness, load)   one step; with a memory it may take from the load
//     mode(strength, memory, stress)                        how a bond broke
//
// Its loops are compiled from a template; a scene runs those of the criteria that its bonds have. The material class
// that gives bonds this criterion is a pair of files, see BondedMat.hpp. No other file knows a criterion by name.
#pragma once

#include <pkg/bonded/kernel/BondStress.hpp>
#include <pkg/ddem/kernel/algebra/Parameters.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace yade::ddem {

/// A bond that is about to be made.
struct BondMaking {
	BondElasticity elasticity;
	double         length;           ///< d0 [m]
	double         radius1, radius2; ///< of the particles [m]
};

/// What a bond does in a step.
template <class Number> struct BondAnswerOf {
	BondStressOf<Number> stress;
	Number               overload; ///< the bond breaks above zero [of any unit]
	Number               lost;     ///< dissipated in this step [J]
};
using BondAnswer = BondAnswerOf<double>;

template <class Number> struct NoBondMemory {
	static constexpr std::array<const char*, 0> names {};
};

/// The lower value of every parameter.
template <class Parameters> Parameters lowest(Parameters a, const Parameters& b)
{
	for (const ParameterEntry& entry : Parameters::entries())
		entry.set(&a, std::min(entry.get(&a), entry.get(&b)));
	return a;
}

constexpr std::size_t mostStrengths = 6, mostMemories = 4;
/// Strength or memory of a bond of any criterion; those that it does not have are zero.
using BondStrength = std::array<double, mostStrengths>;
using BondMemory   = std::array<double, mostMemories>;

/// A criterion behind one face; there is one object of each, which lives for ever.
class BondCriterion {
public:
	using Values = std::vector<double>; ///< of the parameters, in the order of entries()

	virtual ~BondCriterion()                                                            = default;
	virtual std::string                        name() const                             = 0;
	virtual const std::vector<ParameterEntry>& entries() const                          = 0;
	virtual std::vector<std::string>           strengthNames() const                    = 0;
	virtual std::vector<std::string>           memoryNames() const                      = 0;
	/// \throws std::invalid_argument naming `who`, the parameter, its value, its unit and the way out
	virtual void         check(const Values& parameters, const std::string& who) const  = 0;
	virtual Values       weaker(const Values& one, const Values& other) const           = 0;
	virtual BondStrength strengthOf(const Values& parameters, const BondMaking&) const  = 0;
	virtual Values       scaled(const Values& parameters, double factor) const          = 0;
	virtual double       radius(const Values& parameters, const BondMaking&) const      = 0;
	/// One step of one bond.
	virtual BondAnswer
	advance(const BondStrength&, BondMemory&, const BondSection&, const BondStiffness&, BondResultants&) const = 0;
	/// Energy that it has taken from a bond so far [J]: what the bond remembers as "lost".
	virtual double      lostBy(const BondMemory&) const                                                  = 0;
	virtual BondFailure mode(const BondStrength&, const BondMemory&, const BondStress&) const             = 0;
};

/// The one object of a criterion.
template <class Criterion> const BondCriterion& bondCriterion();

/// That of a name. \throws std::invalid_argument where there is none
const BondCriterion& bondCriterion(const std::string& name);

} // namespace yade::ddem
