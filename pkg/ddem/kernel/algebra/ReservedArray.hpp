// GPL v2 or later, see LICENSE.
// An array that grows without moving.
#pragma once

#include <sys/mman.h>

#include <algorithm>
#include <cstddef>
#include <new>
#include <stdexcept>
#include <utility>

namespace yade::ddem {

/** Array of plain numbers with address space for `capacity` of them. Pages become resident when they are first
 * written, so room that is not used costs nothing, and views of the array stay valid while it grows. */
template <class T> class ReservedArray {
public:
	ReservedArray() = default;
	ReservedArray(const ReservedArray& other) { *this = other; }
	ReservedArray(ReservedArray&& other) noexcept { swap(other); }
	ReservedArray& operator=(const ReservedArray& other)
	{
		if (this == &other) return *this;
		reserve(std::max(other.room, other.count));
		resize(other.count);
		std::copy(other.begin(), other.end(), begin());
		return *this;
	}
	ReservedArray& operator=(ReservedArray&& other) noexcept
	{
		swap(other);
		return *this;
	}
	~ReservedArray() { release(); }

	/// Drops the contents and reserves room for so many. \throws std::bad_alloc if there is no address space.
	void reserve(std::size_t capacity)
	{
		release();
		if (capacity == 0) return;
		void* const space
		        = mmap(nullptr, capacity * sizeof(T), PROT_READ | PROT_WRITE,
		               MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
		if (space == MAP_FAILED) throw std::bad_alloc();
		numbers = static_cast<T*>(space);
		room    = capacity;
	}
	/// \throws std::length_error beyond what is reserved.
	void resize(std::size_t newSize)
	{
		if (newSize > room) throw std::length_error("ReservedArray: more elements than were reserved");
		if (newSize > count) std::fill(numbers + count, numbers + newSize, T());
		count = newSize;
	}
	/// So many of one value, with room for `capacity`.
	void assign(std::size_t newSize, T value, std::size_t capacity = 0)
	{
		reserve(std::max(newSize, capacity));
		count = newSize;
		std::fill(begin(), end(), value);
	}

	std::size_t size() const { return count; }
	std::size_t capacity() const { return room; }
	bool        empty() const { return count == 0; }
	T*          data() { return numbers; }
	const T*    data() const { return numbers; }
	T&          operator[](std::size_t i) { return numbers[i]; }
	const T&    operator[](std::size_t i) const { return numbers[i]; }
	T*          begin() { return numbers; }
	T*          end() { return numbers + count; }
	const T*    begin() const { return numbers; }
	const T*    end() const { return numbers + count; }

	friend bool operator==(const ReservedArray& a, const ReservedArray& b)
	{
		return a.count == b.count && std::equal(a.begin(), a.end(), b.begin());
	}
	friend bool operator!=(const ReservedArray& a, const ReservedArray& b) { return !(a == b); }

private:
	T*          numbers = nullptr;
	std::size_t count = 0, room = 0;

	void swap(ReservedArray& other)
	{
		std::swap(numbers, other.numbers);
		std::swap(count, other.count);
		std::swap(room, other.room);
	}
	void release()
	{
		if (numbers) munmap(numbers, room * sizeof(T));
		numbers = nullptr;
		count = room = 0;
	}
};

} // namespace yade::ddem
