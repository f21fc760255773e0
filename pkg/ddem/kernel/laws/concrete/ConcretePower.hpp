// GPL v2 or later, see LICENSE.
// Powers with an exponent known in advance: the usual ones cost no general power.
#pragma once

#include <pkg/ddem/kernel/algebra/Select.hpp>

#include <cmath>

namespace yade::ddem {

/// x^n for x ≥ 0 with n fixed when it is made. The exponents of Zubelewicz (2018) are recognised once, so that an
/// evaluation costs a predicted branch instead of a general power.
class Power {
public:
	explicit Power(double n);

	template <class Number> Number operator()(const Number& x) const
	{
		using std::cbrt;
		using std::pow;
		using std::sqrt;
		switch (kind_) {
			case Kind::Zero: return Number(1);
			case Kind::Half: return sqrt(x);
			case Kind::TwoThirds: {
				const Number root = cbrt(x);
				return root * root;
			}
			case Kind::One: return x;
			case Kind::Two: return x * x;
			default: return select(x > 0, pow(x, Number(exponent_)), Number(0));
		}
	}

	[[gnu::always_inline]] double exponent() const { return exponent_; }
	[[gnu::always_inline]] bool   isHalf() const { return kind_ == Kind::Half; }
	[[gnu::always_inline]] bool   isTwoThirds() const { return kind_ == Kind::TwoThirds; }
	[[gnu::always_inline]] bool   isOne() const { return kind_ == Kind::One; }
	[[gnu::always_inline]] bool   isTwo() const { return kind_ == Kind::Two; }

private:
	enum class Kind { Zero, Half, TwoThirds, One, Two, General };

	double exponent_;
	Kind   kind_;
};

} // namespace yade::ddem
