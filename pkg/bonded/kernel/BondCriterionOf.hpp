// GPL v2 or later, see LICENSE.
// A criterion of bonds behind the face that all have.
#pragma once

#include <pkg/bonded/kernel/BondCriterion.hpp>

#include <algorithm>

namespace yade::ddem {

/// A struct of numbers filled from, and written to, plain ones: what loops and objects keep in columns.
template <class Columns, class Number> Columns fromNumbers(const Number* from)
{
	Columns columns {};
	if constexpr (Columns::names.size() > 0) {
		static_assert(
		        sizeof(Columns) == Columns::names.size() * sizeof(Number), "numbers only, one for a name");
		std::copy_n(from, Columns::names.size(), reinterpret_cast<Number*>(&columns));
	}
	return columns;
}
template <class Columns, class Number> void toNumbers(const Columns& columns, Number* to)
{
	if constexpr (Columns::names.size() > 0)
		std::copy_n(reinterpret_cast<const Number*>(&columns), Columns::names.size(), to);
}

template <class Criterion> class BondCriterionOf final : public BondCriterion {
public:
	using Strength   = typename Criterion::template Strength<double>;
	using Memory     = typename Criterion::template Memory<double>;
	using Parameters = typename Criterion::Parameters;
	static_assert(Strength::names.size() <= mostStrengths && Memory::names.size() <= mostMemories);

	std::string                        name() const override { return Criterion::name; }
	const std::vector<ParameterEntry>& entries() const override { return Parameters::entries(); }
	std::vector<std::string>           strengthNames() const override
	{
		return { Strength::names.begin(), Strength::names.end() };
	}
	std::vector<std::string> memoryNames() const override { return { Memory::names.begin(), Memory::names.end() }; }
	void check(const Values& values, const std::string& who) const override
	{
		const Parameters parameters = parametersOf(values);
		checkParameters(who.c_str(), entries(), &parameters);
	}
	Values weaker(const Values& one, const Values& other) const override
	{
		return valuesOf(Criterion::weaker(parametersOf(one), parametersOf(other)));
	}
	BondStrength strengthOf(const Values& values, const BondMaking& bond) const override
	{
		BondStrength result {};
		toNumbers(Criterion::strengthOf(parametersOf(values), bond), result.data());
		return result;
	}
	Values scaled(const Values& values, double factor) const override
	{
		return valuesOf(Criterion::scaled(parametersOf(values), factor));
	}
	double radius(const Values& values, const BondMaking& bond) const override
	{
		return Criterion::radius(parametersOf(values), bond);
	}
	BondAnswer
	advance(const BondStrength& strength, BondMemory& memory, const BondSection& section,
	        const BondStiffness& stiffness, BondResultants& load) const override
	{
		auto             own    = fromNumbers<Memory>(memory.data());
		const BondAnswer answer = Criterion::advance(
		        fromNumbers<Strength>(strength.data()), own, section, stiffness, load);
		toNumbers(own, memory.data());
		return answer;
	}
	double lostBy(const BondMemory& memory) const override
	{
		double lost = 0;
		for (std::size_t k = 0; k < Memory::names.size(); k++)
			if (Memory::names[k] == std::string("lost")) lost += memory[k];
		return lost;
	}
	BondFailure
	mode(const BondStrength& strength, const BondMemory& memory, const BondStress& stress) const override
	{
		return Criterion::mode(
		        fromNumbers<Strength>(strength.data()), fromNumbers<Memory>(memory.data()), stress);
	}

	static Values valuesOf(const Parameters& parameters)
	{
		Values result;
		for (const ParameterEntry& entry : Parameters::entries())
			result.push_back(entry.get(&parameters));
		return result;
	}

private:
	static Parameters parametersOf(const Values& values)
	{
		Parameters  parameters;
		std::size_t i = 0;
		for (const ParameterEntry& entry : Parameters::entries())
			entry.set(&parameters, values.at(i++));
		return parameters;
	}
};

template <class Criterion> const BondCriterion& bondCriterion()
{
	static const BondCriterionOf<Criterion> only;
	return only;
}

} // namespace yade::ddem
