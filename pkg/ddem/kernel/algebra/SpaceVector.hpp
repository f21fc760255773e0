// GPL v2 or later, see LICENSE.
// Vectors and rotations of space over any number type: one code for scalars and for SIMD lanes.
#pragma once

#include <cmath>

namespace yade::ddem {

/// Vector of space.
template <class Number> struct SpaceVector {
	Number x, y, z;
};

template <class Number> inline SpaceVector<Number> operator+(const SpaceVector<Number>& a, const SpaceVector<Number>& b)
{
	return { a.x + b.x, a.y + b.y, a.z + b.z };
}
template <class Number> inline SpaceVector<Number> operator-(const SpaceVector<Number>& a, const SpaceVector<Number>& b)
{
	return { a.x - b.x, a.y - b.y, a.z - b.z };
}
template <class Number> inline SpaceVector<Number> operator-(const SpaceVector<Number>& a)
{
	return { -a.x, -a.y, -a.z };
}
template <class Number> inline SpaceVector<Number> operator*(const Number& s, const SpaceVector<Number>& a)
{
	return { s * a.x, s * a.y, s * a.z };
}
template <class Number> inline Number              dot(const SpaceVector<Number>& a, const SpaceVector<Number>& b)
{
	return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Number> inline SpaceVector<Number> cross(const SpaceVector<Number>& a, const SpaceVector<Number>& b)
{
	return { a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x };
}
template <class Number> inline Number norm(const SpaceVector<Number>& a)
{
	using std::sqrt;
	return sqrt(dot(a, a));
}

/// Unit quaternion.
template <class Number> struct SpaceRotation {
	Number              w, x, y, z;
	SpaceVector<Number> vector() const { return { x, y, z }; }
};

template <class Number> inline SpaceRotation<Number> inverse(const SpaceRotation<Number>& a)
{
	return { a.w, -a.x, -a.y, -a.z };
}
template <class Number> inline Number                dot(const SpaceRotation<Number>& a, const SpaceRotation<Number>& b)
{
	return a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z;
}
/// First b, then a.
template <class Number>
inline SpaceRotation<Number> operator*(const SpaceRotation<Number>& a, const SpaceRotation<Number>& b)
{
	return { a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
		 a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
		 a.w * b.y + a.y * b.w + a.z * b.x - a.x * b.z,
		 a.w * b.z + a.z * b.w + a.x * b.y - a.y * b.x };
}
template <class Number>
inline SpaceRotation<Number> operator+(const SpaceRotation<Number>& a, const SpaceRotation<Number>& b)
{
	return { a.w + b.w, a.x + b.x, a.y + b.y, a.z + b.z };
}
template <class Number> inline SpaceRotation<Number> operator*(const Number& s, const SpaceRotation<Number>& a)
{
	return { s * a.w, s * a.x, s * a.y, s * a.z };
}

/// Right-handed orthonormal axes.
template <class Number> struct Axes {
	SpaceVector<Number> first, second, third;

	SpaceVector<Number> components(const SpaceVector<Number>& v) const
	{
		return { dot(first, v), dot(second, v), dot(third, v) };
	}
	SpaceVector<Number> vector(const SpaceVector<Number>& components) const
	{
		return components.x * first + components.y * second + components.z * third;
	}
};

/// Axes turned by a quaternion, whose length need not be one.
template <class Number> inline Axes<Number> axesOf(const SpaceRotation<Number>& q)
{
	const Number s = 2. / dot(q, q), sx = s * q.x, sy = s * q.y, sz = s * q.z;
	const Number xx = q.x * sx, yy = q.y * sy, zz = q.z * sz, xy = q.x * sy, xz = q.x * sz, yz = q.y * sz,
	             wx = q.w * sx, wy = q.w * sy, wz = q.w * sz;
	return { { 1. - (yy + zz), xy + wz, xz - wy },
		 { xy - wz, 1. - (xx + zz), yz + wx },
		 { xz + wy, yz - wx, 1. - (xx + yy) } };
}

} // namespace yade::ddem
