// GPL v2 or later, see LICENSE.
// Plane tensors against full 3×3 matrices.
#include "../ConcreteSamples.hpp"

#include <gtest/gtest.h>

namespace {

using namespace yade::ddem;
using namespace yade::ddem::test;

TEST(PlaneTensor, agreesWithFullMatrices)
{
	Random random(1);
	for (int i = 0; i < 100; ++i) {
		const PlaneTensor     a = random.tensor(2), b = random.tensor(3);
		const Eigen::Matrix3d A = matrixOf(a), B = matrixOf(b);
		EXPECT_NEAR(trace(a), A.trace(), 1e-14);
		EXPECT_NEAR(doubleDot(a, b), (A.array() * B.array()).sum(), 1e-13);
		EXPECT_NEAR(norm(a), A.norm(), 1e-14);
		EXPECT_LT((matrixOf(a + 2.5 * b - a) - 2.5 * B).norm(), 1e-13);
		EXPECT_LT((matrixOf(symmetricProduct(a, b)) - 0.5 * (A * B + B * A)).norm(), 1e-13);
		EXPECT_LT((matrixOf(sandwich(a, b)) - A * B * A).norm(), 1e-12);
	}
}

TEST(PlaneTensor, pressureIsPositiveInCompression) { EXPECT_DOUBLE_EQ(pressure(PlaneTensor { -3, -6, -9, 4 }), 6); }

} // namespace
