// GPL v2 or later, see LICENSE.
// Vectors and in-plane tensors over any number type: one code for scalars and for SIMD lanes.
#pragma once

namespace yade::ddem {

/// Vector of the plane.
template <class Number> struct PlaneVector {
	Number x, y;
};

template <class Number> inline PlaneVector<Number> operator+(const PlaneVector<Number>& a, const PlaneVector<Number>& b)
{
	return { a.x + b.x, a.y + b.y };
}
template <class Number> inline PlaneVector<Number> operator-(const PlaneVector<Number>& a, const PlaneVector<Number>& b)
{
	return { a.x - b.x, a.y - b.y };
}
template <class Number> inline PlaneVector<Number> operator-(const PlaneVector<Number>& a) { return { -a.x, -a.y }; }
template <class Number> inline PlaneVector<Number> operator*(const Number& s, const PlaneVector<Number>& a)
{
	return { s * a.x, s * a.y };
}
template <class Number> inline Number              dot(const PlaneVector<Number>& a, const PlaneVector<Number>& b)
{
	return a.x * b.x + a.y * b.y;
}
/// Out-of-plane component of a × b.
template <class Number> inline Number cross(const PlaneVector<Number>& a, const PlaneVector<Number>& b)
{
	return a.x * b.y - a.y * b.x;
}
/// e_z × a: a turned by +90°.
template <class Number> inline PlaneVector<Number> turned(const PlaneVector<Number>& a) { return { -a.y, a.x }; }

/// In-plane components of a symmetric tensor; xy is the tensor component, not the engineering shear.
template <class Number> struct InPlaneTensor {
	Number xx, yy, xy;
};

/// Traction-like product T·a.
template <class Number>
inline PlaneVector<Number> operator*(const InPlaneTensor<Number>& t, const PlaneVector<Number>& a)
{
	return { t.xx * a.x + t.xy * a.y, t.xy * a.x + t.yy * a.y };
}

} // namespace yade::ddem
