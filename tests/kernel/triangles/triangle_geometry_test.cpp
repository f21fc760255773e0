// GPL v2 or later, see LICENSE.
// Reference geometry of the triangle: areas, and what makes a triangle unusable.
#include "../TriangleSamples.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace {

using namespace yade::ddem;
using namespace yade::ddem::samples;

/// The message of the exception, or what to see in the test's output if there is none.
std::string refusal(const Vertices& v)
{
	try {
		makeReference(v);
	} catch (const std::invalid_argument& e) {
		return e.what();
	}
	return "accepted";
}

void expectWords(const std::string& message, std::initializer_list<const char*> words)
{
	for (const char* word : words)
		EXPECT_NE(message.find(word), std::string::npos) << "'" << word << "' is missing in: " << message;
}

TEST(TriangleReference, centreCutsItIntoThreeEqualSubElements)
{
	Random random(1);
	for (int i = 0; i < 1000; i++) {
		const Vertices v         = random.skewedTriangle();
		const auto     reference = makeReference(v);
		const double   area      = 0.5 * cross(v[1] - v[0], v[2] - v[0]);
		const Point    c         = centroid(v);
		EXPECT_NEAR(reference.area(), area, 1e-13 * area);
		for (std::size_t k = 0; k < 3; k++) {
			EXPECT_NEAR(cross(v[k] - c, v[(k + 1) % 3] - c), reference.twiceSubArea(), 1e-13 * area);
			EXPECT_NEAR(reference.arm[k].x, v[k].x - c.x, 1e-14 * std::sqrt(area) * 20);
			EXPECT_NEAR(reference.arm[k].y, v[k].y - c.y, 1e-14 * std::sqrt(area) * 20);
		}
	}
}

TEST(TriangleReference, smallestHeightStandsOnTheLongestEdge) // 3-4-5 triangle: 12/5
{
	EXPECT_DOUBLE_EQ(smallestHeight(makeReference({ { { 0, 0 }, { 4, 0 }, { 0, 3 } } })), 2.4);
}

TEST(TriangleReference, refusesClockwiseOrderAndOffersTheFlip)
{
	expectWords(
	        refusal({ { { 0.25, 0 }, { 0, 3.5 }, { 4, 0 } } }),
	        { "clockwise", "(0.25, 0)", "(0, 3.5)", "(4, 0)", " m", "swap", "flip" });
}

TEST(TriangleReference, refusesDegenerateTriangles)
{
	expectWords(
	        refusal({ { { 0, 0 }, { 1.5, 1.5 }, { 3, 3 } } }),
	        { "degenerate", "(0, 0)", "(1.5, 1.5)", "(3, 3)", "line", "remesh" });
	expectWords(refusal({ { { 2, 1 }, { 2, 1 }, { 3, 3 } } }), { "degenerate", "(2, 1)" });
	expectWords(refusal({ { { 2, 1 }, { 2, 1 }, { 2, 1 } } }), { "degenerate", "(2, 1)" });
	// neither order would be right: not called clockwise
	expectWords(refusal({ { { 0, 0 }, { 1, -1e-11 }, { 2, 0 } } }), { "degenerate" });
}

TEST(TriangleReference, flatnessIsJudgedByShapeNotBySize)
{
	for (const double size : { 1e-9, 1., 1e9 }) {
		const auto flat = [size](double height) {
			return Vertices { { { 0, 0 }, { size, 0 }, { 0.3 * size, height * size } } };
		};
		EXPECT_EQ(refusal(flat(2e-10)), "accepted") << size;
		expectWords(refusal(flat(0.5e-10)), { "degenerate" });
	}
}

TEST(TriangleReference, refusesCoordinatesThatAreNotFinite)
{
	const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
	for (const double bad : { nan, infinity, -infinity })
		for (std::size_t e = 0; e < 3; e++)
			for (double Point::* component : { &Point::x, &Point::y }) {
				Vertices v                = { { { 0, 0 }, { 4, 0.5 }, { 0, 3 } } };
				v[e].*component           = bad;
				const std::string message = refusal(v);
				expectWords(message, { "not a finite number", std::isnan(bad) ? "nan" : "inf" });
			}
}

} // namespace
