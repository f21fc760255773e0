// GPL v2 or later, see LICENSE.
// Arrays that grow without moving.
#include <pkg/ddem/kernel/algebra/ReservedArray.hpp>

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <string>
#include <unistd.h>

namespace {

using yade::ddem::ReservedArray;

TEST(ReservedArray, growsWithoutMovingUpToWhatWasReserved)
{
	ReservedArray<double> a;
	a.assign(3, 7., 1000);
	const double* const place = a.data();
	a.resize(1000);
	EXPECT_EQ(a.data(), place);
	EXPECT_EQ(a[2], 7);
	EXPECT_EQ(a[999], 0);
	EXPECT_THROW(a.resize(1001), std::length_error);
	a.resize(2);
	a.resize(3);
	EXPECT_EQ(a[2], 0) << "what comes again is new";
}

TEST(ReservedArray, copiesAreEqualAndApart)
{
	ReservedArray<double> a;
	a.assign(4, 1., 100);
	ReservedArray<double> b = a;
	EXPECT_EQ(a, b);
	EXPECT_EQ(b.capacity(), 100u);
	b[3] = 2;
	EXPECT_NE(a, b);
	a = b;
	EXPECT_EQ(a[3], 2);
	ReservedArray<double> empty;
	a = empty;
	EXPECT_TRUE(a.empty());
	EXPECT_EQ(a.begin(), a.end());
}

/// Resident memory of this process [bytes].
std::size_t resident()
{
	std::ifstream statm("/proc/self/statm");
	std::size_t   size = 0, pages = 0;
	statm >> size >> pages;
	return pages * std::size_t(sysconf(_SC_PAGESIZE));
}

TEST(ReservedArray, roomThatIsNotUsedIsNotResident)
{
	const std::size_t     before = resident(), room = std::size_t(1) << 27; // 1 GiB
	ReservedArray<double> a;
	a.assign(1000, 1., room);
	EXPECT_LT(resident(), before + (std::size_t(1) << 24));
	a.resize(std::size_t(1) << 23);
	EXPECT_GT(resident(), before + (std::size_t(1) << 25)); // and what is used is
}

} // namespace
