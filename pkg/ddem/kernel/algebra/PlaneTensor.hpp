// GPL v2 or later, see LICENSE.
// Symmetric second-order tensor of plane strain: stress, strain, damage of one sub-element.
#pragma once

#include <pkg/ddem/kernel/algebra/Select.hpp>

#include <cmath>

namespace yade::ddem {

/// Symmetric tensor with the components that plane strain leaves: the in-plane block and zz. `xy` is the tensor
/// component, not the engineering shear (twice it), so a double dot counts it twice.
/// Number is double or a SIMD batch of doubles.
template <class Number> struct PlaneTensorOf {
	Number xx, yy, zz, xy;
};

using PlaneTensor = PlaneTensorOf<double>;

template <class Number>
inline PlaneTensorOf<Number> operator+(const PlaneTensorOf<Number>& a, const PlaneTensorOf<Number>& b)
{
	return { a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy };
}

template <class Number>
inline PlaneTensorOf<Number> operator-(const PlaneTensorOf<Number>& a, const PlaneTensorOf<Number>& b)
{
	return { a.xx - b.xx, a.yy - b.yy, a.zz - b.zz, a.xy - b.xy };
}

template <class Number>
inline PlaneTensorOf<Number> operator*(const typename Same<Number>::Type& s, const PlaneTensorOf<Number>& a)
{
	return { s * a.xx, s * a.yy, s * a.zz, s * a.xy };
}

/// Component by component.
template <class Condition, class Number>
inline PlaneTensorOf<Number>
select(const Condition& condition, const PlaneTensorOf<Number>& yes, const PlaneTensorOf<Number>& no)
{
	return { select(condition, yes.xx, no.xx), select(condition, yes.yy, no.yy), select(condition, yes.zz, no.zz),
		 select(condition, yes.xy, no.xy) };
}

template <class Number> inline Number trace(const PlaneTensorOf<Number>& a) { return a.xx + a.yy + a.zz; }

/// a : b
template <class Number> inline Number doubleDot(const PlaneTensorOf<Number>& a, const PlaneTensorOf<Number>& b)
{
	return a.xx * b.xx + a.yy * b.yy + a.zz * b.zz + 2 * (a.xy * b.xy);
}

/// sqrt(a : a)
template <class Number> inline Number norm(const PlaneTensorOf<Number>& a)
{
	using std::sqrt;
	return sqrt(doubleDot(a, a));
}

/// Pressure [Pa] of a stress [Pa], positive in compression.
template <class Number> inline Number pressure(const PlaneTensorOf<Number>& stress)
{
	return (-1. / 3) * trace(stress);
}

/// Symmetric part of the product a.b
template <class Number>
inline PlaneTensorOf<Number> symmetricProduct(const PlaneTensorOf<Number>& a, const PlaneTensorOf<Number>& b)
{
	return { a.xx * b.xx + a.xy * b.xy, a.yy * b.yy + a.xy * b.xy, a.zz * b.zz,
		 0.5 * ((a.xx + a.yy) * b.xy + (b.xx + b.yy) * a.xy) };
}

/// a.b.a, symmetric because a and b are
template <class Number>
inline PlaneTensorOf<Number> sandwich(const PlaneTensorOf<Number>& a, const PlaneTensorOf<Number>& b)
{
	// rows of the in-plane block of a.b
	const Number xx = a.xx * b.xx + a.xy * b.xy, xy = a.xx * b.xy + a.xy * b.yy;
	const Number yx = a.xy * b.xx + a.yy * b.xy, yy = a.xy * b.xy + a.yy * b.yy;
	return { xx * a.xx + xy * a.xy, yx * a.xy + yy * a.yy, a.zz * b.zz * a.zz, xx * a.xy + xy * a.yy };
}

} // namespace yade::ddem
