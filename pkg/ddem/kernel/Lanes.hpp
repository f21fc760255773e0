// GPL v2 or later, see LICENSE.
// Loads and stores of one number or of a SIMD batch, so that the element loops are written once.
#pragma once

#include <xsimd/xsimd.hpp>

#include <cstddef>
#include <cstdint>

namespace yade::ddem {

template <class Number> struct Lanes;

template <> struct Lanes<double> {
	static constexpr std::size_t width = 1;
	static double                load(const double* from) { return *from; }
	static void                  store(double* to, double value) { *to = value; }
	static double                gather(const double* from, const std::int32_t* index, int stride, int offset) { return from[stride * *index + offset]; }
	/// Component of interleaved pairs (x, y), and its inverse.
	static double loadPairs(const double* from, int component) { return from[component]; }
	static void   storePairs(double* to, double x, double y)
	{
		to[0] = x;
		to[1] = y;
	}
	static double sum(double value) { return value; }
};

template <class Arch> struct Lanes<xsimd::batch<double, Arch>> {
	using Batch                        = xsimd::batch<double, Arch>;
	static constexpr std::size_t width = Batch::size;
	static Batch                 load(const double* from) { return Batch::load_unaligned(from); }
	static void                  store(double* to, const Batch& value) { value.store_unaligned(to); }
	/// Scalar loads: on the processors of today as fast as the gather instruction, and free of its index conversions.
	static Batch gather(const double* from, const std::int32_t* index, int stride, int offset)
	{
		alignas(Arch::alignment()) double lane[width];
		for (std::size_t i = 0; i < width; i++)
			lane[i] = from[stride * index[i] + offset];
		return Batch::load_aligned(lane);
	}
	static Batch loadPairs(const double* from, int component)
	{
		alignas(Arch::alignment()) double lane[width];
		for (std::size_t i = 0; i < width; i++)
			lane[i] = from[2 * i + component];
		return Batch::load_aligned(lane);
	}
	static void storePairs(double* to, const Batch& x, const Batch& y)
	{
		xsimd::zip_lo(x, y).store_unaligned(to);
		xsimd::zip_hi(x, y).store_unaligned(to + width);
	}
	static double sum(const Batch& value) { return xsimd::reduce_add(value); }
};

} // namespace yade::ddem
