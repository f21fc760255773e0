// GPL v2 or later, see LICENSE.
// Symmetric second-order tensor of plane strain: stress, strain, damage of one sub-element.
#pragma once

#include <cmath>

namespace yade {
namespace ddem {

	/*! Symmetric tensor with the components that plane strain leaves: the in-plane block and zz. `xy` is the tensor component,
	not the engineering shear (twice it), so a double dot counts it twice. Passive data of four doubles. */
	struct PlaneTensor {
		double xx, yy, zz, xy;

		PlaneTensor& operator+=(const PlaneTensor& o)
		{
			xx += o.xx;
			yy += o.yy;
			zz += o.zz;
			xy += o.xy;
			return *this;
		}
		PlaneTensor& operator-=(const PlaneTensor& o)
		{
			xx -= o.xx;
			yy -= o.yy;
			zz -= o.zz;
			xy -= o.xy;
			return *this;
		}
		PlaneTensor& operator*=(double s)
		{
			xx *= s;
			yy *= s;
			zz *= s;
			xy *= s;
			return *this;
		}
	};

	inline PlaneTensor operator+(PlaneTensor a, const PlaneTensor& b) { return a += b; }
	inline PlaneTensor operator-(PlaneTensor a, const PlaneTensor& b) { return a -= b; }
	inline PlaneTensor operator*(PlaneTensor a, double s) { return a *= s; }
	inline PlaneTensor operator*(double s, PlaneTensor a) { return a *= s; }

	inline double trace(const PlaneTensor& a) { return a.xx + a.yy + a.zz; }

	//! a : b
	inline double doubleDot(const PlaneTensor& a, const PlaneTensor& b) { return a.xx * b.xx + a.yy * b.yy + a.zz * b.zz + 2 * a.xy * b.xy; }

	//! sqrt(a : a)
	inline double norm(const PlaneTensor& a) { return std::sqrt(doubleDot(a, a)); }

	//! Pressure [Pa] of a stress [Pa], positive in compression.
	inline double pressure(const PlaneTensor& stress) { return -trace(stress) / 3; }

	//! Symmetric part of the product a.b
	inline PlaneTensor symmetricProduct(const PlaneTensor& a, const PlaneTensor& b)
	{
		return { a.xx * b.xx + a.xy * b.xy,
			 a.yy * b.yy + a.xy * b.xy,
			 a.zz * b.zz,
			 0.5 * ((a.xx + a.yy) * b.xy + (b.xx + b.yy) * a.xy) };
	}

	//! a.b.a, symmetric because a and b are
	inline PlaneTensor sandwich(const PlaneTensor& a, const PlaneTensor& b)
	{
		// rows of the in-plane block of a.b
		const double xx = a.xx * b.xx + a.xy * b.xy, xy = a.xx * b.xy + a.xy * b.yy;
		const double yx = a.xy * b.xx + a.yy * b.xy, yy = a.xy * b.xy + a.yy * b.yy;
		return { xx * a.xx + xy * a.xy, yx * a.xy + yy * a.yy, a.zz * b.zz * a.zz, xx * a.xy + xy * a.yy };
	}

	//! The tensor R.a.R^T, R the rotation about z by `angle` [rad]: components in axes against which the old ones stand turned by `angle`.
	inline PlaneTensor rotated(const PlaneTensor& a, double angle)
	{
		const double c = std::cos(2 * angle), s = std::sin(2 * angle), mean = 0.5 * (a.xx + a.yy), half = 0.5 * (a.xx - a.yy);
		const double along = c * half - s * a.xy;
		return { mean + along, mean - along, a.zz, s * half + c * a.xy };
	}

} // namespace ddem
} // namespace yade
