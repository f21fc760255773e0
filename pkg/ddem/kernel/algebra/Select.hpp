// GPL v2 or later, see LICENSE.
// Choice without a branch for one number; for a SIMD batch the functions of the same name are found by its namespace.
#pragma once

namespace yade::ddem {

// Always inline: this header is compiled with different instruction sets, and the linker keeps one copy of a function
// that is not inlined.
[[gnu::always_inline]] inline double select(bool condition, double yes, double no) { return condition ? yes : no; }
[[gnu::always_inline]] inline bool   any(bool condition) { return condition; }

/// The type itself, but not deduced from an argument: lets a double stand for a batch of equal numbers.
template <class Number> struct Same {
	using Type = Number;
};

} // namespace yade::ddem
