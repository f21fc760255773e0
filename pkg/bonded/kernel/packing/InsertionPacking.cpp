// GPL v2 or later, see LICENSE.
#include <pkg/bonded/kernel/packing/InsertionPacking.hpp>
#include <pkg/bonded/kernel/packing/SphereGrid.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <utility>

namespace yade::ddem {

namespace {
	constexpr double        touching  = 1e-10;   // gap or overlap of spheres that touch, of the largest radius
	constexpr int           turns     = 30;      // at most, for a sphere at a cylinder; a few are needed
	constexpr std::uint64_t tickEvery = 1 << 13; // points, a few milliseconds

	/// Uniform numbers; std::uniform_real_distribution differs from library to library, the engine does not.
	class Draw {
	public:
		explicit Draw(std::uint64_t seed) : engine(seed) { }
		double unit() { return double(engine() >> 11) * 0x1p-53; } ///< in [0, 1)
		double between(double from, double to) { return from + (to - from) * unit(); }

	private:
		std::mt19937_64 engine;
	};

	template <int dimension> class Packer {
	public:
		static constexpr std::size_t touches = std::size_t(dimension) + 1;

		Packer(const Specimen& s, const PackingOrder& o)
		        : specimen(s)
		        , order(o)
		        , tolerance(touching * o.largest)
		        , draw(o.seed)
		        , grid(dimension, s.lower, s.upper, o.smallest, o.largest)
		        , width(norm(s.upper - s.lower))
		{
		}

		InsertionPacking pack()
		{
			seed();
			const std::size_t seeds = grid.spheres().size();
			for (std::uint64_t failed = 0, points = 0; failed < order.fails; points++) {
				if (order.tick && points % tickEvery == 0) order.tick();
				const auto sphere = sphereAt(pointInside());
				if (sphere) grid.add(*sphere);
				failed = sphere ? 0 : failed + 1;
			}
			return { grid.spheres(), seeds };
		}

	private:
		void seed()
		{
			const double              r    = order.largest;
			const double              rows = std::sqrt(3.) * r, layers = 2 * std::sqrt(2. / 3) * r;
			const SpaceVector<double> size = specimen.upper - specimen.lower;
			const auto                steps = [](double way, double step) {
                                return std::int64_t(std::ceil(way / step));
			};
			const std::int64_t nx = steps(size.x, 2 * r), ny = steps(size.y, rows);
			const std::int64_t nz = dimension == 3 ? steps(size.z, layers) : 0;
			for (std::int64_t i = 0; i <= nx; i++)
				for (std::int64_t j = 0; j <= ny; j++) {
					if (order.tick) order.tick();
					for (std::int64_t k = 0; k <= nz; k++)
						seedAt(specimen.lower
						       + SpaceVector<double> {
						               r + double(2 * i + j % 2 + k % 2) * r,
						               r + (double(j) + double(k % 2) / 3) * rows,
						               dimension == 3 ? r + double(k) * layers : 0 });
				}
		}
		/// A sphere of random radius near a point, where it finds room there.
		void seedAt(const SpaceVector<double>& point)
		{
			const double room = std::min(specimen.depth(point), order.largest);
			if (!(room > order.smallest)) return;
			const double radius = draw.between(order.smallest, 0.5 * (order.smallest + room));
			const double jitter = room - radius;
			// one by one: the order in which arguments are evaluated is the compiler's
			const double       x = draw.between(-jitter, jitter), y = draw.between(-jitter, jitter);
			const double       z = dimension == 3 ? draw.between(-jitter, jitter) : 0;
			const PackedSphere sphere { point + SpaceVector<double> { x, y, z }, radius };
			if (fits(sphere)) grid.add(sphere);
		}
		bool fits(const PackedSphere& sphere) const
		{
			return specimen.depth(sphere.centre) >= sphere.radius - tolerance
			        && !grid.overlaps(sphere, tolerance);
		}
		SpaceVector<double> pointInside()
		{
			while (true) {
				SpaceVector<double> point { 0, 0, 0 };
				point.x = draw.between(specimen.lower.x, specimen.upper.x);
				point.y = draw.between(specimen.lower.y, specimen.upper.y);
				if (dimension == 3) point.z = draw.between(specimen.lower.z, specimen.upper.z);
				if (specimen.depth(point) > 0) return point;
			}
		}

		/// The sphere that touches what is closest to a point, where it may stay.
		std::optional<PackedSphere> sphereAt(const SpaceVector<double>& point) const
		{
			ClosestThings closest(touches);
			if (!closestTo(point, closest)) return {};
			std::array<PackedSphere, 2> found;
			const int                   count = tangent(closest, point, found);
			for (int i = 0; i < count; i++) {
				PackedSphere& sphere = found[std::size_t(i)];
				if (!settle(sphere, closest)) continue;
				if (fits(sphere)) return sphere;
			}
			return {};
		}
		/// Things by number: spheres from 0 upwards, walls from -1 downwards.
		bool closestTo(const SpaceVector<double>& point, ClosestThings& closest) const
		{
			ClosestThings walls(touches);
			for (std::size_t w = 0; w < specimen.walls.size(); w++)
				walls.offer(specimen.walls[w].distance(point), -1 - std::int32_t(w));
			for (double reach = 2 * order.smallest;; reach *= 2) {
				closest = walls;
				grid.offerAround(point, reach, closest);
				if (closest.limit() <= reach || reach > width) return closest.full();
			}
		}
		const SpecimenWall& wall(std::int32_t number) const { return specimen.walls[std::size_t(-1 - number)]; }
		Touched             thing(std::int32_t number, const SpaceVector<double>& near) const
		{
			if (number < 0) return wall(number).touchedNear(near);
			const PackedSphere& sphere = grid.spheres()[std::size_t(number)];
			return { sphere.centre, sphere.radius, false };
		}
		/// Tangent spheres, that closer to the point first.
		int tangent(
		        const ClosestThings&         closest,
		        const SpaceVector<double>&   point,
		        std::array<PackedSphere, 2>& found) const
		{
			bool round = false;
			for (std::size_t i = 0; i < touches; i++)
				round = round || (closest[i] < 0 && wall(closest[i]).kind == WallKind::Cylinder);
			SpaceVector<double> near = point;
			for (int turn = 0; turn < turns; turn++) {
				std::array<Touched, touches> things;
				for (std::size_t i = 0; i < touches; i++)
					things[i] = thing(closest[i], near);
				const int count = tangentSpheres<dimension>(things, found);
				if (count == 2 && norm(found[1].centre - near) < norm(found[0].centre - near))
					std::swap(found[0], found[1]);
				if (count == 0 || !round) return count;
				// A cylinder is a hollow ball at the height of the sphere:
				// Newton's method, of second order.
				const double moved = norm(found[0].centre - near);
				near               = found[0].centre;
				if (moved <= 1e-3 * tolerance) return 1;
			}
			return 0;
		}
		/// Lets a sphere touch what it was made to touch without overlap; false where it does not.
		bool settle(PackedSphere& sphere, const ClosestThings& closest) const
		{
			double least = std::numeric_limits<double>::infinity(), most = -least;
			for (std::size_t i = 0; i < touches; i++) {
				const double distance = thing(closest[i], sphere.centre).distance(sphere.centre);
				least                 = std::min(least, distance);
				most                  = std::max(most, distance);
			}
			sphere.radius = least;
			return most - least <= tolerance && least >= order.smallest && least <= order.largest;
		}

		const Specimen&     specimen;
		const PackingOrder& order;
		const double        tolerance;
		Draw                draw;
		SphereGrid          grid;
		const double        width;
	};
}

InsertionPacking fillSpecimen(const Specimen& specimen, const PackingOrder& order)
{
	return specimen.dimension == 2 ? Packer<2>(specimen, order).pack() : Packer<3>(specimen, order).pack();
}

} // namespace yade::ddem
