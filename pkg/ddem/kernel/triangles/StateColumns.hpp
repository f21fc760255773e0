// GPL v2 or later, see LICENSE.
// State of the triangles of one law group: columns in tiles, and the one list of fields that says what the columns are.
#pragma once

#include <pkg/ddem/kernel/algebra/Lanes.hpp>
#include <pkg/ddem/kernel/algebra/PlaneTensor.hpp>
#include <pkg/ddem/kernel/triangles/Tiles.hpp>

#include <xsimd/xsimd.hpp>

#include <string>
#include <vector>

namespace yade::ddem {

/// What a field of a law's state is made of.
enum class FieldKind {
	Scalar,  ///< a number
	InPlane, ///< symmetric tensor without zz: xx, yy, xy
	Tensor   ///< symmetric tensor of plane strain: xx, yy, zz, xy
};

constexpr std::size_t componentsOf(FieldKind kind)
{
	return kind == FieldKind::Scalar ? 1 : kind == FieldKind::InPlane ? 3 : 4;
}

/// A field of the state of a sub-element, as saving, carrying over, numpy, material point and ParaView read it.
struct StateField {
	std::string name, unit;
	FieldKind   kind;
	std::size_t column; ///< its first

	std::size_t components() const { return componentsOf(kind); }
};

// A law lists its fields once, in the order of their columns, by calling a visitor:
//
//     template <unsigned effects, class State, class Visit> static void fields(State& s, Visit&& visit)
//     {
//             visit.scalar("largestStrain", "-", s.largestStrain);
//             if constexpr (effects & LawEffects::Energy) visit.scalar("damageDissipation", "J/m³",
//             s.damageDissipation);
//     }
//
// Fields that only the energy book needs come last, so that the book can be opened and closed during a run.

/// Collects the list itself.
struct ListFields {
	std::vector<StateField> list;
	std::size_t             columns = 0;

	template <class T> void scalar(const char* name, const char* unit, T&) { add(name, unit, FieldKind::Scalar); }
	template <class T> void inPlane(const char* name, const char* unit, T&) { add(name, unit, FieldKind::InPlane); }
	template <class T> void tensor(const char* name, const char* unit, T&) { add(name, unit, FieldKind::Tensor); }

private:
	void add(const char* name, const char* unit, FieldKind kind)
	{
		list.push_back({ name, unit, kind, columns });
		columns += componentsOf(kind);
	}
};

/// Reads a sub-element's columns, which lie `stride` numbers apart. Tensors in plane are strains, whose zz does not
/// change: it is that of the initial strain.
template <class Number> struct LoadFields {
	const double* from;
	std::size_t   stride;
	Number        outOfPlane = Number(0.);

	void scalar(const char*, const char*, Number& to) { to = next(); }
	void inPlane(const char*, const char*, PlaneTensorOf<Number>& to)
	{
		to.xx = next();
		to.yy = next();
		to.zz = outOfPlane;
		to.xy = next();
	}
	void tensor(const char*, const char*, PlaneTensorOf<Number>& to)
	{
		to.xx = next();
		to.yy = next();
		to.zz = next();
		to.xy = next();
	}

private:
	Number next()
	{
		const double* const here = from;
		from += stride;
		return Lanes<Number>::load(here);
	}
};

/// Writes them.
template <class Number> struct StoreFields {
	double*     to;
	std::size_t stride;

	void scalar(const char*, const char*, const Number& from) { next(from); }
	void inPlane(const char*, const char*, const PlaneTensorOf<Number>& from)
	{
		next(from.xx);
		next(from.yy);
		next(from.xy);
	}
	void tensor(const char*, const char*, const PlaneTensorOf<Number>& from)
	{
		next(from.xx);
		next(from.yy);
		next(from.zz);
		next(from.xy);
	}

private:
	void next(const Number& value)
	{
		Lanes<Number>::store(to, value);
		to += stride;
	}
};

/// Writes those of some lanes, and leaves the others.
template <class Number, class Lane> struct StoreSomeFields {
	double*     to;
	std::size_t stride;
	Lane        lanes;

	void scalar(const char*, const char*, const Number& from) { next(from); }
	void inPlane(const char*, const char*, const PlaneTensorOf<Number>& from)
	{
		next(from.xx);
		next(from.yy);
		next(from.xy);
	}
	void tensor(const char*, const char*, const PlaneTensorOf<Number>& from)
	{
		next(from.xx);
		next(from.yy);
		next(from.zz);
		next(from.xy);
	}

private:
	void next(const Number& value)
	{
		Lanes<Number>::store(to, select(lanes, value, Lanes<Number>::load(to)));
		to += stride;
	}
};

/** Columns of the sub-elements of so many triangles. A tile is one piece of memory: column after column, in a column
 * sub-element after sub-element, in a sub-element triangle after triangle, filled up to whole batches. */
class StateColumns {
public:
	void resize(std::size_t triangles, std::size_t columns)
	{
		rows    = triangles;
		width   = columns;
		numbers = Numbers(3 * columns * paddedRows(), 0.);
	}
	std::size_t triangles() const { return rows; }
	std::size_t columns() const { return width; }
	std::size_t bytes() const { return numbers.size() * sizeof(double); }
	/// Rows of all tiles, with what fills up the last.
	std::size_t paddedRows() const { return rows / tileSize * tileSize + padded(rows % tileSize); }

	/// Start of a tile.
	double*       tile(std::size_t t) { return numbers.data() + t * tileSize * 3 * width; }
	const double* tile(std::size_t t) const { return numbers.data() + t * tileSize * 3 * width; }
	/// Distance in a tile from a sub-element's number to that of the next sub-element of the triangle;
	/// three of them to the next column.
	std::size_t stride(std::size_t t) const
	{
		return (t + 1) * tileSize <= rows ? tileSize : padded(rows % tileSize);
	}

	/// Column 0 of sub-element k of a triangle (or of what fills up its tile); further columns are 3·stride apart.
	double* row(std::size_t triangle, std::size_t k) { return tile(triangle / tileSize) + place(triangle, k); }
	const double* row(std::size_t triangle, std::size_t k) const
	{
		return tile(triangle / tileSize) + place(triangle, k);
	}
	std::size_t   columnStep(std::size_t triangle) const { return 3 * stride(triangle / tileSize); }

	/// Copies the last triangle into what fills up the last tile.
	void fillUp()
	{
		if (rows == 0) return;
		for (std::size_t i = rows; i < paddedRows(); i++)
			for (std::size_t k = 0; k < 3; k++)
				for (std::size_t c = 0; c < width; c++)
					row(i, k)[c * columnStep(i)] = row(rows - 1, k)[c * columnStep(i)];
	}

private:
	using Numbers = std::vector<double, xsimd::aligned_allocator<double, 64>>;
	Numbers     numbers;
	std::size_t rows = 0, width = 0;

	std::size_t place(std::size_t triangle, std::size_t k) const
	{
		return k * stride(triangle / tileSize) + triangle % tileSize;
	}
};

} // namespace yade::ddem
