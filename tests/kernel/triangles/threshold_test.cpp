// GPL v2 or later, see LICENSE.
// Tiles below the threshold of their law, which are elastic.
#include "../LooseTriangles.hpp"

#include <laws/AllLaws.hpp>

#include <gtest/gtest.h>

namespace {

using namespace yade::ddem;
using namespace yade::ddem::samples;

template <class Law> class Threshold : public testing::Test {
};
template <class... Laws> struct TypesOf {
	using Type = testing::Types<Laws...>;
};
TYPED_TEST_SUITE(Threshold, AllLaws<TypesOf>::Type);

TYPED_TEST(Threshold, isCrossedWithTheBitsOfTheLaw)
{
	if constexpr (!TypeParam::hasThreshold(0)) GTEST_SKIP() << "this law has none";
	else {
		// Two samples of two tiles. In one of them every tile has a triangle beyond the threshold, so it runs
		// the law.
		const auto amplitude
		        = [](std::size_t i) { return i % 256 == 7 ? 5e-2 : 2e-2 * (1 + double(i % 13)) / 13; };
		const auto path = [](double t, double size, std::size_t i) {
			const double phase = 0.3 * double(i);
			return (size * t) * PlaneTensor { std::sin(phase), std::cos(phase), 0, std::sin(2 * phase) };
		};
		Loose      below = Loose::of<TypeParam>(300, 0), law = below;
		const auto go = [&](double t) {
			below.step([&](std::size_t i) { return path(t, i % 256 == 7 ? 1e-6 : amplitude(i), i); }, 1e-7);
			law.step([&](std::size_t i) { return path(t, amplitude(i), i); }, 1e-7);
		};
		law.step([&](std::size_t i) { return path(i % 256 == 7 ? 1 : 1e-9, amplitude(i), i); }, 1e-7);
		const auto reached = [&](const Loose& sample) {
			// a state that has changed
			std::size_t count = 0;
			for (std::size_t i = 0; i < 300; i++) {
				const Loose virgin = Loose::of<TypeParam>(1, 0);
				for (const StateField& f : virgin.system.group[0]->fields())
					if (sample.values(f.name, i, 1) != virgin.values(f.name, 0, 1)) {
						count++;
						break;
					}
			}
			return count;
		};
		EXPECT_EQ(reached(below), 0u);
		EXPECT_EQ(reached(law), 2u);
		for (int s = 1; s <= 100; s++) {
			go(s == 1 ? 1e-3 : 0.01 * s);
			for (std::size_t i = 0; i < 300; i++)
				if (i % 256 != 7) {
					ASSERT_EQ(below.outputs(i), law.outputs(i))
					        << "step " << s << ", triangle " << i;
				}
			if (s == 1) {
				EXPECT_EQ(reached(below), 0u);
			}
		}
		EXPECT_GT(reached(below), 100u);
	}
}

TYPED_TEST(
        Threshold, leavesTheStateAloneBelow) // what the loop for virgin tiles relies on: the law itself says the same
{
	if constexpr (!TypeParam::hasThreshold(0)) GTEST_SKIP() << "this law has none";
	else {
		typename TypeParam::Parameters     parameters;
		const typename TypeParam::Prepared law(parameters);
		const TriangleProperties           properties(1e-6, -1, 1, { 0, 0, 0, 0 });
		const auto                         own    = TypeParam::propertiesOf(law, properties);
		const auto                         virgin = TypeParam::virgin(law, properties);
		Random                             random(77);
		int                                below = 0, beyond = 0;
		for (int i = 0; i < 20000; i++) {
			const double      size = std::pow(10., random.uniform(-6, -2));
			const PlaneTensor strain {
				random.uniform(-size, size), random.uniform(-size, size), 0, random.uniform(-size, size)
			};
			auto                state  = virgin;
			const PlaneTensor   stress = TypeParam::template advance<0>(law, own, strain, 1e-7, state);
			const bool          maybe  = TypeParam::template beyondThreshold<0>(law, own, strain);
			std::vector<double> was(100), is(100);
			auto                copy = virgin;
			TypeParam::template fields<0>(copy, StoreFields<double> { was.data(), 1 });
			TypeParam::template fields<0>(state, StoreFields<double> { is.data(), 1 });
			const bool changed = was != is;
			(maybe ? beyond : below)++;
			EXPECT_FALSE(changed && !maybe)
			        << "strain " << strain.xx << ", " << strain.yy << ", " << strain.xy;
			EXPECT_FALSE(maybe && !changed) << "strain " << strain.xx << ", " << strain.yy << ", "
			                                << strain.xy; // not early, but for rounding
			if (!maybe) {
				EXPECT_EQ(norm(stress - elasticStress(law.lambda, law.twoShear, strain)), 0);
			}
		}
		EXPECT_GT(below, 2000);
		EXPECT_GT(beyond, 2000);
	}
}

TYPED_TEST(Threshold, isFoundAgainAfterTheBookWasClosedAndAfterLoading)
{
	if constexpr (!TypeParam::hasThreshold(0)) GTEST_SKIP() << "this law has none";
	else {
		const auto path = [](int s) {
			return [=](std::size_t i) {
				return (1e-5 * s * (1 + double(i % 7))) * PlaneTensor { 1, -0.3, 0, 0.5 };
			};
		};
		Loose booked = Loose::of<TypeParam>(20, 0), plain = booked;
		for (int s = 1; s <= 150; s++) {
			booked.step(path(s), 1e-7, s < 2 || (s > 40 && s < 90));
			plain.step(path(s), 1e-7);
			if (s == 60) { // loaded in the middle
				Loose loaded = Loose::of<TypeParam>(20, 0);
				for (const StateField& f : plain.group().fields())
					for (std::size_t i = 0; i < 20; i++)
						for (std::size_t k = 0; k < 3; k++)
							loaded.group().set(
							        *loaded.group().field(f.name),
							        i,
							        k,
							        plain.values(f.name, i, k).data());
				loaded.group().fillUp();
				plain = loaded;
			}
		}
		for (const StateField& f : plain.group().fields()) // without the book's
			for (std::size_t i = 0; i < 20; i++)
				for (std::size_t c = 0; c < f.components();
				     c++) // the book's loop may round in another way
					EXPECT_NEAR(
					        plain.values(f.name, i, 0)[c], booked.values(f.name, i, 0)[c], 1e-13)
					        << f.name;
	}
}

} // namespace
