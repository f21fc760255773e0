// GPL v2 or later, see LICENSE.
#include <pkg/bonded/kernel/BondLoopBodies.hpp>
#include <pkg/bonded/kernel/SphereMotion.hpp>

#include <limits>
#include <stdexcept>

namespace yade::ddem {

namespace {

	struct Baseline;

	constexpr std::size_t widest        = 4; ///< bonds in the widest SIMD batch
	constexpr std::size_t bondsPerChunk = 256;
	constexpr int         particlesPerChunk = 64;

	static_assert(sizeof(BondSystem::Row) == 12 * sizeof(double), "loops store three quads a bond");
	static_assert(bondsPerChunk % widest == 0, "batches must not reach into the next chunk");

	std::size_t padded(std::size_t count) { return (count + widest - 1) / widest * widest; }

} // namespace

BondLoop selectBondLoop(BondConvention convention)
{
	if (const BondLoop wide = selectBondLoopAvx2(convention)) return wide;
	return bondLoopFor<Baseline, double>(convention);
}

void BondSystem::clear() { *this = BondSystem(); }

void BondSystem::add(
        std::int32_t firstParticle, std::int32_t secondParticle, const Bond& bond, const MohrCoulomb& strength)
{
	if (first.size() != count) throw std::logic_error("BondSystem: bonds are added before it is assembled");
	count++;
	first.push_back(firstParticle);
	second.push_back(secondParticle);
	const double values[ConstantCount] = { bond.stiffness.normal,
		                               bond.stiffness.shear,
		                               bond.stiffness.bending,
		                               bond.stiffness.torsion,
		                               bond.length,
		                               bond.radius1,
		                               bond.radius2,
		                               bond.frame1.w,
		                               bond.frame1.x,
		                               bond.frame1.y,
		                               bond.frame1.z,
		                               bond.frame2.w,
		                               bond.frame2.x,
		                               bond.frame2.y,
		                               bond.frame2.z,
		                               strength.cohesion,
		                               strength.frictionCoefficient,
		                               strength.tensionLimit() };
	for (std::size_t k = 0; k < ConstantCount; k++)
		constants[k].push_back(values[k]);
}

void BondSystem::assemble(std::size_t particleCount)
{
	first.resize(count);
	second.resize(count);
	collectStart.assign(particleCount + 1, 0);
	for (const auto* list : { &first, &second })
		for (const std::int32_t p : *list) {
			if (p < 0 || std::size_t(p) >= particleCount)
				throw std::logic_error("BondSystem: a bond names a particle that does not exist");
			collectStart[std::size_t(p) + 1]++;
		}
	for (std::size_t p = 0; p < particleCount; p++)
		collectStart[p + 1] += collectStart[p];
	collectRow.resize(2 * count);
	std::vector<std::size_t> next(collectStart.begin(), collectStart.end() - 1);
	for (std::size_t j = 0; j < count; j++) {
		collectRow[next[std::size_t(first[j])]++]  = std::int32_t(2 * j);
		collectRow[next[std::size_t(second[j])]++] = std::int32_t(2 * j + 1);
	}

	// What SIMD batches read beyond the end: the last bond again, without strength limit;
	// nobody collects its results.
	const std::size_t length = padded(count);
	for (auto* list : { &first, &second })
		list->resize(length, count ? list->back() : 0);
	for (auto& list : constants) {
		list.resize(count);
		list.resize(length, count ? list.back() : 0.);
	}
	for (const Constant k : { Cohesion, TensionLimit })
		std::fill(
		        constants[k].begin() + std::ptrdiff_t(count), constants[k].end(),
		        std::numeric_limits<double>::infinity());
	rows.assign(length, Row {});
}

double BondSystem::step(
        BondConvention convention, bool energy, const double* pose, double* load, std::vector<std::int32_t>& overloaded)
{
	overloaded.clear();
	BondArrays arrays { first.data(), second.data(), pose, {}, reinterpret_cast<double*>(rows.data()) };
	for (std::size_t k = 0; k < ConstantCount; k++)
		arrays.constant[k] = constants[k].data();
	const BondLoop    loop   = selectBondLoop(convention);
	const auto chunks = std::ptrdiff_t((count + bondsPerChunk - 1) / bondsPerChunk),
	           all = std::ptrdiff_t(particles());
	over.assign(std::size_t(chunks), 0);
	stored.assign(std::size_t(chunks), 0.);
#pragma omp parallel
	{
#pragma omp for schedule(static)
		for (std::ptrdiff_t c = 0; c < chunks; c++) {
			const std::size_t begin = std::size_t(c) * bondsPerChunk,
			                  end = std::min(begin + bondsPerChunk, count);
			over[std::size_t(c)] = loop(arrays, begin, end);
			if (energy)
				for (std::size_t j = begin; j < end; j++)
					stored[std::size_t(c)] += rows[j].energy;
		}
#pragma omp for schedule(static, particlesPerChunk)
		for (std::ptrdiff_t p = 0; p < all; p++)
			collect(std::size_t(p), load);
	}
	double sum = 0;
	for (std::ptrdiff_t c = 0; c < chunks; c++) {
		sum += stored[std::size_t(c)];
		if (!over[std::size_t(c)]) continue;
		const std::size_t begin = std::size_t(c) * bondsPerChunk, end = std::min(begin + bondsPerChunk, count);
		for (std::size_t j = begin; j < end; j++) {
			const BondStress stress { rows[j].normalStress, rows[j].shearStress };
			if (!(bondOverload(
			              constants[Cohesion][j], constants[Friction][j], constants[TensionLimit][j],
			              stress)
			      <= 0))
				overloaded.push_back(std::int32_t(j));
		}
	}
	return sum;
}

void BondSystem::remove(std::size_t bond, double* load)
{
	// computed as before, in its batch, but without effect
	for (const Constant k : { Normal, Shear, Bending, Torsion })
		constants[k][bond] = 0;
	constants[Cohesion][bond] = constants[TensionLimit][bond] = std::numeric_limits<double>::infinity();
	rows[bond]                                                = Row {};
	collect(std::size_t(first[bond]), load);
	collect(std::size_t(second[bond]), load);
}

void BondSystem::collect(std::size_t particle, double* load) const
{
	SpaceVector<double> force { 0, 0, 0 }, moment { 0, 0, 0 };
	for (std::size_t k = collectStart[particle]; k < collectStart[particle + 1]; k++) {
		const Row& r = rows[std::size_t(collectRow[k] / 2)];
		if (collectRow[k] % 2 == 0) {
			force  = force + r.force;
			moment = moment + r.moment1;
		} else {
			force  = force - r.force;
			moment = moment + r.moment2;
		}
	}
	double* const to = load + sphereRow * std::ptrdiff_t(particle);
	to[0]            = force.x;
	to[1]            = force.y;
	to[2]            = force.z;
	to[4]            = moment.x;
	to[5]            = moment.y;
	to[6]            = moment.z;
}

} // namespace yade::ddem
