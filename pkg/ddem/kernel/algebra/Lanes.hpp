// GPL v2 or later, see LICENSE.
// Loads and stores of one number or of a SIMD batch, so that the element loops are written once.
#pragma once

#include <pkg/ddem/kernel/algebra/PlaneVector.hpp>

#include <xsimd/xsimd.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace yade::ddem {

template <class Number> struct Lanes;

template <> struct Lanes<double> {
	static constexpr std::size_t width = 1;
	static double                load(const double* from) { return *from; }
	static void                  store(double* to, double value) { *to = value; }
	static double                sum(double value) { return value; }
	/// Points that lie behind each other as x, y.
	static PlaneVector<double> loadPoints(const double* from) { return { from[0], from[1] }; }
	static void                storePoints(double* to, const PlaneVector<double>& value)
	{
		to[0] = value.x;
		to[1] = value.y;
	}
	/// Points of the given indices.
	static PlaneVector<double> gatherPoints(const double* from, const std::int32_t* index)
	{
		return loadPoints(from + 2 * std::ptrdiff_t(*index));
	}
	/// Four numbers of each of the given rows, which are `stride` numbers apart.
	static void gatherRows(const double* from, std::ptrdiff_t stride, const std::int32_t* index, double (&to)[4])
	{
		std::copy_n(from + stride * *index, 4, to);
	}
	static double                largest(double value) { return value; }
	/// Four numbers of each of successive rows, which are `stride` numbers apart.
	static void loadRows(const double* from, std::ptrdiff_t, double (&to)[4]) { std::copy_n(from, 4, to); }
	static void storeRows(double* to, std::ptrdiff_t, const double (&from)[4]) { std::copy_n(from, 4, to); }
};

#if defined(__AVX2__)
/// Four lanes. Points are loaded whole, two coordinates at once, and transposed in registers:
/// faster than gather instructions or single loads.
template <class Arch> struct Lanes<xsimd::batch<double, Arch>> {
	using Batch                        = xsimd::batch<double, Arch>;
	static constexpr std::size_t width = 4;
	static_assert(Batch::size == width);
	static Batch  load(const double* from) { return Batch::load_unaligned(from); }
	static void   store(double* to, const Batch& value) { value.store_unaligned(to); }
	static double sum(const Batch& value) { return xsimd::reduce_add(value); }

	static PlaneVector<Batch> loadPoints(const double* from)
	{
		const __m256d first = _mm256_loadu_pd(from), second = _mm256_loadu_pd(from + 4);
		return split(_mm256_permute2f128_pd(first, second, 0x20), _mm256_permute2f128_pd(first, second, 0x31));
	}
	static void storePoints(double* to, const PlaneVector<Batch>& value)
	{
		const __m256d even = _mm256_unpacklo_pd(value.x, value.y), odd = _mm256_unpackhi_pd(value.x, value.y);
		_mm256_storeu_pd(to, _mm256_permute2f128_pd(even, odd, 0x20));
		_mm256_storeu_pd(to + 4, _mm256_permute2f128_pd(even, odd, 0x31));
	}
	static PlaneVector<Batch> gatherPoints(const double* from, const std::int32_t* index)
	{
		const auto point = [=](int lane) { return _mm_loadu_pd(from + 2 * std::ptrdiff_t(index[lane])); };
		return split(_mm256_set_m128d(point(2), point(0)), _mm256_set_m128d(point(3), point(1)));
	}
	static void gatherRows(const double* from, std::ptrdiff_t stride, const std::int32_t* index, Batch (&to)[4])
	{
		for (int lane = 0; lane < 4; lane++)
			to[lane] = Batch(_mm256_loadu_pd(from + stride * index[lane]));
		transpose(to);
	}
	static double largest(const Batch& value) { return xsimd::reduce_max(value); }
	static void   loadRows(const double* from, std::ptrdiff_t stride, Batch (&to)[4])
	{
		for (int lane = 0; lane < 4; lane++)
			to[lane] = Batch(_mm256_loadu_pd(from + lane * stride));
		transpose(to);
	}
	static void storeRows(double* to, std::ptrdiff_t stride, const Batch (&from)[4])
	{
		Batch rows[4] = { from[0], from[1], from[2], from[3] };
		transpose(rows);
		for (int lane = 0; lane < 4; lane++)
			_mm256_storeu_pd(to + lane * stride, rows[lane]);
	}

private:
	static void transpose(Batch (&m)[4])
	{
		const __m256d a = _mm256_unpacklo_pd(m[0], m[1]), b = _mm256_unpackhi_pd(m[0], m[1]),
		              c = _mm256_unpacklo_pd(m[2], m[3]), d = _mm256_unpackhi_pd(m[2], m[3]);
		m[0] = Batch(_mm256_permute2f128_pd(a, c, 0x20));
		m[1] = Batch(_mm256_permute2f128_pd(b, d, 0x20));
		m[2] = Batch(_mm256_permute2f128_pd(a, c, 0x31));
		m[3] = Batch(_mm256_permute2f128_pd(b, d, 0x31));
	}

	/// From points 0, 2 and points 1, 3.
	static PlaneVector<Batch> split(__m256d even, __m256d odd)
	{
		return { Batch(_mm256_unpacklo_pd(even, odd)), Batch(_mm256_unpackhi_pd(even, odd)) };
	}
};
#else
/// Lanes of the instructions that every processor of the architecture has, one after the other.
template <class Arch> struct Lanes<xsimd::batch<double, Arch>> {
	using Batch                        = xsimd::batch<double, Arch>;
	static constexpr std::size_t width = Batch::size;
	static Batch                 load(const double* from) { return Batch::load_unaligned(from); }
	static void                  store(double* to, const Batch& value) { value.store_unaligned(to); }
	static double                sum(const Batch& value) { return xsimd::reduce_add(value); }

	static PlaneVector<Batch> loadPoints(const double* from)
	{
		return ofPoints([=](std::size_t lane) { return from + 2 * lane; });
	}
	static void storePoints(double* to, const PlaneVector<Batch>& value)
	{
		alignas(Batch) double x[width], y[width];
		value.x.store_aligned(x);
		value.y.store_aligned(y);
		for (std::size_t lane = 0; lane < width; lane++) {
			to[2 * lane]     = x[lane];
			to[2 * lane + 1] = y[lane];
		}
	}
	static PlaneVector<Batch> gatherPoints(const double* from, const std::int32_t* index)
	{
		return ofPoints([=](std::size_t lane) { return from + 2 * std::ptrdiff_t(index[lane]); });
	}

private:
	template <class Place> static PlaneVector<Batch> ofPoints(const Place& place)
	{
		alignas(Batch) double x[width], y[width];
		for (std::size_t lane = 0; lane < width; lane++) {
			x[lane] = place(lane)[0];
			y[lane] = place(lane)[1];
		}
		return { Batch::load_aligned(x), Batch::load_aligned(y) };
	}
};
#endif

} // namespace yade::ddem
