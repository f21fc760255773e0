// GPL v2 or later, see LICENSE.
#include <pkg/bonded/kernel/BondDamping.hpp>
#include <pkg/bonded/kernel/SphereLoopBodies.hpp>
#include <pkg/ddem/kernel/triangles/TileSums.hpp>

#include <algorithm>

namespace yade::ddem {

namespace {

	struct Baseline;

	constexpr std::size_t widest  = 4;   ///< spheres in the widest SIMD batch
	constexpr std::size_t perTile = 256; ///< spheres whose energies are summed together

	std::size_t tilesOf(std::size_t spheres) { return (spheres + perTile - 1) / perTile; }

} // namespace

SphereLoop selectSphereLoop(unsigned effects)
{
	if (const SphereLoop wide = selectSphereLoopAvx2(effects)) return wide;
	return sphereLoopFor<Baseline, double>(effects);
}

void SphereMotion::resize(std::size_t spheres)
{
	count                = spheres;
	const std::size_t length = (spheres + widest - 1) / widest * widest;
	for (auto* rows : { &pose, &velocity, &load })
		rows->assign(std::size_t(sphereRow) * length, 0.);
	for (std::size_t p = 0; p < length; p++)
		poseOf(p)[4] = 1;
	mass.assign(length, 0.);
	inertia.assign(length, 0.);
	axesBlocked.assign(length, 0);
	free.clear();
}

void SphereMotion::setMass(std::size_t sphere, double ofSphere, double momentOfInertia)
{
	mass[sphere]          = ofSphere;
	inertia[sphere]       = momentOfInertia;
	poseOf(sphere)[3]     = ofSphere > 0 ? 1 / ofSphere : 0;
	velocityOf(sphere)[3] = momentOfInertia > 0 ? 1 / momentOfInertia : 0;
}

void SphereMotion::block(std::size_t sphere, unsigned axes)
{
	if (axes == axesBlocked[sphere]) return;
	axesBlocked[sphere] = std::uint8_t(axes);
	if (free.empty()) free.assign(pose.size(), 1.);
	for (std::size_t c = 0; c < 6; c++)
		free[std::size_t(sphereRow) * sphere + c + (c < 3 ? 0 : 1)] = axes & (1u << c) ? 0 : 1;
}

SphereSums SphereMotion::step(const SphereStep& settings)
{
	const unsigned effects = (free.empty() ? 0u : unsigned(SphereEffects::Blocked))
	        | (settings.damping != 0 ? unsigned(SphereEffects::Damping) : 0u)
	        | (settings.energy ? unsigned(SphereEffects::Energy) : 0u);
	const SphereLoop     loop = selectSphereLoop(effects);
	const SphereArrays   arrays { pose.data(), velocity.data(), load.data(), mass.data(), inertia.data(),
                                    free.empty() ? nullptr : free.data() };
	const std::size_t    length = mass.size();
	const auto           tiles  = std::ptrdiff_t(tilesOf(length));
	std::vector<SphereSums> sums((std::size_t(tiles)));
#pragma omp parallel for schedule(static)
	for (std::ptrdiff_t t = 0; t < tiles; t++) {
		const std::size_t begin = std::size_t(t) * perTile;
		sums[std::size_t(t)]    = loop(arrays, begin, std::min(begin + perTile, length), settings);
	}
	return treeSum(std::move(sums));
}

double SphereMotion::drag(double translation, double rotation, double dt, bool book)
{
	const ViscousDamper linear(translation, dt), angular(rotation, dt);
	const auto          tiles = std::ptrdiff_t(tilesOf(count));
	std::vector<double> loss(std::size_t(tiles), 0.);
#pragma omp parallel for schedule(static)
	for (std::ptrdiff_t t = 0; t < tiles; t++) {
		const std::size_t begin = std::size_t(t) * perTile, end = std::min(begin + perTile, count);
		double            sum   = 0;
		for (std::size_t p = begin; p < end; p++) {
			double* const       to = loadOf(p);
			const double* const v  = velocityOf(p);
			for (std::size_t c = 0; c < 6; c++) {
				const std::size_t    at     = c + (c < 3 ? 0 : 1);
				const ViscousDamper& damper = c < 3 ? linear : angular;
				const double         size   = c < 3 ? mass[p] : inertia[p];
				if (axesBlocked[p] & (1u << c)) continue;
				if (book && size > 0) sum += damper.loss(v[at], to[at], size);
				to[at] += damper.load(v[at], to[at], size);
			}
		}
		loss[std::size_t(t)] = sum;
	}
	return treeSum(std::move(loss));
}

} // namespace yade::ddem
