// GPL v2 or later, see LICENSE.
// The saved form of the state of deformable bodies: one vector of numbers.
#include <pkg/ddem/DeformableAssembly.hpp>

#include <cstring>

namespace yade {

namespace {

	constexpr std::size_t concreteNumbers = 3 * sizeof(ddem::ConcreteState) / sizeof(Real);

	/// Reads numbers one after the other. \throws std::runtime_error past the end.
	class NumberReader {
	public:
		explicit NumberReader(const std::vector<Real>& source)
		        : numbers(source)
		{
		}
		Real next()
		{
			if (place >= numbers.size()) throw std::runtime_error("the saved state of deformable triangles is too short: the file is damaged or from another version of the plugin");
			return numbers[place++];
		}
		void read(std::array<Real, 2>& pair)
		{
			pair[0] = next();
			pair[1] = next();
		}
		bool atEnd() const { return place == numbers.size(); }

	private:
		const std::vector<Real>& numbers;
		std::size_t              place = 0;
	};

	void writePoint(std::vector<Real>& to, Body::id_t id, const CarriedState::Point& p)
	{
		to.insert(to.end(), { Real(id), Real(p.blocked) });
		for (const auto* pair : { &p.position, &p.velocity, &p.force, &p.lastVelocity })
			to.insert(to.end(), pair->begin(), pair->end());
	}

	void readPoint(NumberReader& from, CarriedState::Point& p)
	{
		p.blocked = unsigned(from.next());
		for (auto* pair : { &p.position, &p.velocity, &p.force, &p.lastVelocity })
			from.read(*pair);
	}

} // namespace

std::vector<Real> CarriedState::numbers() const
{
	std::vector<Real> all { Real(nodes.size()), Real(cores.size()), Real(concreteNumbers), pendingWork[0], pendingWork[1], pendingWork[2], lastTimeStep };
	for (const auto& [id, point] : nodes)
		writePoint(all, id, point);
	for (const auto& [id, core] : cores) {
		writePoint(all, id, core);
		all.insert(all.end(), { Real(core.spins), core.angle, core.spin, core.moment, core.lastSpin, Real(!core.concrete.empty()) });
		if (core.concrete.empty()) continue;
		all.resize(all.size() + concreteNumbers);
		std::memcpy(&all[all.size() - concreteNumbers], core.concrete.data(), concreteNumbers * sizeof(Real));
	}
	return all;
}

CarriedState CarriedState::fromNumbers(const std::vector<Real>& all)
{
	CarriedState carried;
	NumberReader from(all);
	const auto   nNodes = std::size_t(from.next()), nCores = std::size_t(from.next());
	if (std::size_t(from.next()) != concreteNumbers) throw std::runtime_error("the saved state of concrete has other variables than this plugin's: load it with the plugin that saved it");
	for (auto& work : carried.pendingWork)
		work = from.next();
	carried.lastTimeStep = from.next();
	for (std::size_t i = 0; i < nNodes; i++)
		readPoint(from, carried.nodes[Body::id_t(from.next())]);
	for (std::size_t i = 0; i < nCores; i++) {
		Core& core = carried.cores[Body::id_t(from.next())];
		readPoint(from, core);
		core.spins = from.next() != 0;
		for (auto* value : { &core.angle, &core.spin, &core.moment, &core.lastSpin })
			*value = from.next();
		if (from.next() == 0) continue;
		core.concrete.resize(3);
		std::array<Real, concreteNumbers> values;
		for (auto& value : values)
			value = from.next();
		std::memcpy(static_cast<void*>(core.concrete.data()), values.data(), sizeof(values));
	}
	if (!from.atEnd()) throw std::runtime_error("the saved state of deformable triangles is too long: the file is damaged or from another version of the plugin");
	return carried;
}

} // namespace yade
