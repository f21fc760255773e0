// GPL v2 or later, see LICENSE.
#include <pkg/bonded/kernel/BondLoopBodies.hpp>
#include <pkg/bonded/kernel/SphereMotion.hpp>

#include <algorithm>
#include <stdexcept>

namespace yade::ddem {

namespace {

	struct Baseline;

	constexpr std::size_t widest        = 4; ///< bonds in the widest SIMD batch
	constexpr std::size_t bondsPerChunk = 256;
	constexpr int         particlesPerChunk = 64;

	static_assert(sizeof(BondSystem::Row) == 12 * sizeof(double), "loops store three quads a bond");
	static_assert(bondsPerChunk % widest == 0, "batches must not reach into the next chunk");

} // namespace

BondLoop selectBondLoop(BondConvention convention, const BondCriterion& criterion)
{
	if (const BondLoop wide = selectBondLoopAvx2(convention, criterion)) return wide;
	return BondLoopOf<Baseline, double> { convention, criterion }.find();
}

void requireKnown(BondConvention convention, const BondCriterion& criterion)
{
	if (selectBondLoop(convention, criterion)) return;
	throw std::invalid_argument(
	        "bonds of " + criterion.name() + ": the convention 'esys' knows bonds of MohrCoulomb only (BondedMat); "
	        "use 'consistent'");
}

void BondSystem::clear() { *this = BondSystem(); }

std::size_t BondSystem::add(std::int32_t firstParticle, std::int32_t secondParticle, const BreakableBond& added)
{
	if (gone.size() != count || !chunks.empty())
		throw std::logic_error("BondSystem: bonds are added before it is assembled");
	if (groups.empty() || groups.back().criterion != added.criterion) {
		fillBatch();
		groups.push_back({ added.criterion, count, count });
	}
	const Bond&  bond                   = added.bond;
	const double values[ConstantCount] = { bond.stiffness.normal,
		                               bond.stiffness.shear,
		                               bond.stiffness.bending,
		                               bond.stiffness.torsion,
		                               bond.length,
		                               bond.radius1,
		                               bond.radius2,
		                               bond.sectionRadius,
		                               bond.frame1.w,
		                               bond.frame1.x,
		                               bond.frame1.y,
		                               bond.frame1.z,
		                               bond.frame2.w,
		                               bond.frame2.x,
		                               bond.frame2.y,
		                               bond.frame2.z };
	first.push_back(firstParticle);
	second.push_back(secondParticle);
	for (std::size_t k = 0; k < ConstantCount; k++)
		constants[k].push_back(values[k]);
	for (std::size_t k = 0; k < mostStrengths; k++)
		strengths[k].push_back(added.strength[k]);
	for (std::size_t k = 0; k < mostMemories; k++)
		memories[k].push_back(added.memory[k]);
	gone.push_back(false);
	groups.back().end = ++count;
	return count - 1;
}

void BondSystem::fillBatch()
{
	while (count % widest != 0) {
		for (auto* list : { &first, &second })
			list->push_back(list->back());
		for (auto& list : constants)
			list.push_back(list.back());
		for (auto& list : strengths)
			list.push_back(list.back());
		for (auto& list : memories)
			list.push_back(list.back());
		gone.push_back(true);
		count++;
	}
}

void BondSystem::assemble(std::size_t particleCount)
{
	fillBatch();
	collectStart.assign(particleCount + 1, 0);
	for (std::size_t j = 0; j < count; j++)
		for (const std::int32_t p : { first[j], second[j] }) {
			if (p < 0 || std::size_t(p) >= particleCount)
				throw std::logic_error("BondSystem: a bond names a particle that does not exist");
			if (!gone[j]) collectStart[std::size_t(p) + 1]++;
		}
	for (std::size_t p = 0; p < particleCount; p++)
		collectStart[p + 1] += collectStart[p];
	collectRow.resize(collectStart.back());
	std::vector<std::size_t> next(collectStart.begin(), collectStart.end() - 1);
	std::size_t              memoryCount = 0;
	for (std::size_t g = 0; g < groups.size(); g++) {
		const Group& group = groups[g];
		memoryCount        = std::max(memoryCount, group.criterion->memoryNames().size());
		for (std::size_t j = group.begin; j < group.end; j++) {
			collectRow[next[std::size_t(first[j])]++]  = std::int32_t(2 * j);
			collectRow[next[std::size_t(second[j])]++] = std::int32_t(2 * j + 1);
		}
		for (std::size_t begin = group.begin; begin < group.end; begin += bondsPerChunk)
			chunks.push_back({ g, begin, std::min(begin + bondsPerChunk, group.end), false, {} });
	}
	for (std::size_t k = memoryCount; k < mostMemories; k++)
		memories[k] = {};
	rows.assign(count, Row {});
	overload.assign(count, 0.);
	lost.assign(memoryCount > 0 ? count : 0, 0.);
}

BondSystem::Energies BondSystem::step(
        BondConvention convention, bool energy, const double* pose, double* load, std::vector<std::int32_t>& overloaded)
{
	overloaded.clear();
	BondArrays arrays { first.data(),    second.data(), pose, {}, {}, {}, reinterpret_cast<double*>(rows.data()),
		            overload.data(), lost.data() };
	for (std::size_t k = 0; k < ConstantCount; k++)
		arrays.constant[k] = constants[k].data();
	for (std::size_t k = 0; k < mostStrengths; k++)
		arrays.strength[k] = strengths[k].data();
	for (std::size_t k = 0; k < mostMemories; k++)
		arrays.memory[k] = memories[k].data();
	std::vector<BondLoop> loops;
	for (const Group& group : groups) {
		requireKnown(convention, *group.criterion);
		loops.push_back(selectBondLoop(convention, *group.criterion));
	}
	const auto of = std::ptrdiff_t(chunks.size()), all = std::ptrdiff_t(particles());
#pragma omp parallel
	{
#pragma omp for schedule(static)
		for (std::ptrdiff_t c = 0; c < of; c++) {
			Chunk& chunk = chunks[std::size_t(c)];
			chunk.over   = loops[chunk.group](arrays, chunk.begin, chunk.end);
			if (energy) addEnergies(chunk);
		}
#pragma omp for schedule(static, particlesPerChunk)
		for (std::ptrdiff_t p = 0; p < all; p++)
			collect(std::size_t(p), load);
	}
	Energies sum;
	for (const Chunk& chunk : chunks) {
		if (energy) {
			sum.stored += chunk.energies.stored;
			sum.lost += chunk.energies.lost;
		}
		if (!chunk.over) continue;
		for (std::size_t j = chunk.begin; j < chunk.end; j++) {
			if (overload[j] <= 0) continue;
			if (!gone[j]) overloaded.push_back(std::int32_t(j));
			overload[j] = 0;
		}
	}
	return sum;
}

void BondSystem::addEnergies(Chunk& chunk) const
{
	const bool remembers = !groups[chunk.group].criterion->memoryNames().empty();
	chunk.energies       = {};
	for (std::size_t j = chunk.begin; j < chunk.end; j++) {
		if (gone[j]) continue;
		chunk.energies.stored += rows[j].energy;
		if (remembers) chunk.energies.lost += lost[j];
	}
}

BondMemory BondSystem::memoryOf(std::size_t bond) const
{
	BondMemory memory {};
	for (std::size_t k = 0; k < mostMemories; k++)
		if (!memories[k].empty()) memory[k] = memories[k][bond];
	return memory;
}

void BondSystem::remove(std::size_t bond, double* load)
{
	// computed as before, in its batch, but without effect
	for (const Constant k : { Normal, Shear, Bending, Torsion })
		constants[k][bond] = 0;
	for (auto& list : memories)
		if (!list.empty()) list[bond] = 0;
	rows[bond] = Row {};
	gone[bond] = true;
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
