// GPL v2 or later, see LICENSE.
// Powers with an exponent known in advance: the usual ones cost no std::pow.
#pragma once

#include <cmath>

namespace yade {
namespace ddem {

	/*! x^n for x ≥ 0 with n fixed when it is made. The exponents of Zubelewicz (2018) are resolved once, so that an evaluation costs a predicted
	branch instead of std::pow. */
	class Power {
	public:
		explicit Power(double n)
		        : exponent_(n)
		        , kind_(kindOf(n))
		{
		}

		double exponent() const { return exponent_; }

		double operator()(double x) const
		{
			switch (kind_) {
				case Kind::Zero: return 1;
				case Kind::Half: return std::sqrt(x);
				case Kind::TwoThirds: {
					const double root = std::cbrt(x);
					return root * root;
				}
				case Kind::One: return x;
				case Kind::Two: return x * x;
				default: return std::pow(x, exponent_);
			}
		}

		bool isHalf() const { return kind_ == Kind::Half; }
		bool isTwoThirds() const { return kind_ == Kind::TwoThirds; }
		bool isOne() const { return kind_ == Kind::One; }

	private:
		enum class Kind { Zero, Half, TwoThirds, One, Two, General };

		static Kind kindOf(double n)
		{
			if (n == 0) return Kind::Zero;
			if (n == 0.5) return Kind::Half;
			if (std::abs(n - 2. / 3) < 1e-12) return Kind::TwoThirds; // 2/3 arrives from tables and scripts with rounding
			if (n == 1) return Kind::One;
			if (n == 2) return Kind::Two;
			return Kind::General;
		}

		double exponent_;
		Kind   kind_;
	};

} // namespace ddem
} // namespace yade
