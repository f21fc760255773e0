// GPL v2 or later, see LICENSE.
#include <pkg/ddem/StateStore.hpp>

#include <algorithm>
#include <sstream>

namespace yade {

namespace {

	[[noreturn]] void damaged(const std::string& what)
	{
		throw std::runtime_error(
		        "the saved state of deformable triangles " + what
		        + ": the file is damaged or from another version of the plugin");
	}

	/// Reads numbers one after the other. \throws std::runtime_error past the end.
	class NumberReader {
	public:
		explicit NumberReader(const std::vector<Real>& source)
		        : numbers(source)
		{
		}
		Real next()
		{
			if (place >= numbers.size()) damaged("is too short");
			return numbers[place++];
		}
		/// A count of things of which each takes at least one number.
		std::size_t count()
		{
			const Real value = next();
			if (!(value >= 0 && value <= Real(numbers.size()))) damaged("has an impossible count");
			return std::size_t(value);
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

	void writePoint(std::vector<Real>& to, Body::id_t id, const StateStore::Point& p)
	{
		to.insert(to.end(), { Real(id), Real(p.blocked) });
		for (const auto* pair : { &p.position, &p.velocity, &p.force, &p.lastVelocity })
			to.insert(to.end(), pair->begin(), pair->end());
	}

	void readPoint(NumberReader& from, StateStore::Point& p)
	{
		p.blocked = unsigned(from.next());
		for (auto* pair : { &p.position, &p.velocity, &p.force, &p.lastVelocity })
			from.read(*pair);
	}

} // namespace

std::size_t StateStore::kindOf(const ddem::LawGroup& group)
{
	Fields mine;
	for (const ddem::StateField& f : group.fields()) {
		mine.names.push_back(f.name);
		mine.components.push_back(f.components());
		mine.numbers += f.components();
	}
	for (std::size_t i = 0; i < kinds.size(); i++)
		if (kinds[i].names == mine.names && kinds[i].components == mine.components) return i;
	kinds.push_back(mine);
	return kinds.size() - 1;
}

void StateStore::keep(Body::id_t id, const ddem::LawGroup& group, std::size_t triangle)
{
	if (group.fields().empty()) return;
	Memory& memory = memories[id];
	memory.fields  = kindOf(group);
	memory.numbers.clear();
	for (std::size_t k = 0; k < 3; k++)
		for (const ddem::StateField& f : group.fields()) {
			double values[4];
			group.get(f, triangle, k, values);
			memory.numbers.insert(memory.numbers.end(), values, values + f.components());
		}
}

std::set<std::string> StateStore::missing(Body::id_t id, const ddem::LawGroup& group) const
{
	std::set<std::string> names;
	for (const ddem::StateField& field : group.fields())
		names.insert(field.name);
	const auto found = memories.find(id);
	if (found == memories.end()) return names;
	for (const std::string& name : kinds[found->second.fields].names)
		names.erase(name);
	return names;
}

void StateStore::take(StateStore&& other)
{
	if (cores.empty()) {
		*this = std::move(other);
		return;
	}
	nodes.merge(other.nodes);
	cores.merge(other.cores);
	for (std::size_t i = 0; i < pendingWork.size(); i++)
		pendingWork[i] += other.pendingWork[i];
	for (auto& [id, memory] : other.memories) {
		const Fields& fields = other.kinds[memory.fields];
		const auto    same
		        = [&](const Fields& f) { return f.names == fields.names && f.components == fields.components; };
		const auto    kind   = std::find_if(kinds.begin(), kinds.end(), same);
		memory.fields        = std::size_t(kind - kinds.begin());
		if (kind == kinds.end()) kinds.push_back(fields);
		memories[id] = std::move(memory);
	}
}

std::set<std::string> StateStore::give(Body::id_t id, ddem::LawGroup& group, std::size_t triangle) const
{
	std::set<std::string> unknown;
	const auto            found = memories.find(id);
	if (found == memories.end()) return unknown;
	const Fields& known = kinds[found->second.fields];
	std::size_t   place = 0;
	for (std::size_t f = 0; f < known.names.size(); f++) {
		const ddem::StateField* field = group.field(known.names[f]);
		if (!field || field->components() != known.components[f])
			unknown.insert(known.names[f]);
		else
			for (std::size_t k = 0; k < 3; k++)
				group.set(*field, triangle, k, &found->second.numbers[k * known.numbers + place]);
		place += known.components[f];
	}
	return unknown;
}

StateStore::Saved StateStore::saved() const
{
	Saved to;
	for (const Fields& kind : kinds) {
		std::ostringstream line; // a kind of memory: its fields with their sizes
		for (std::size_t f = 0; f < kind.names.size(); f++)
			line << (f ? " " : "") << kind.names[f] << ":" << kind.components[f];
		to.names.push_back(line.str());
	}
	std::vector<Real>& all = to.numbers;
	all = { Real(nodes.size()), Real(cores.size()) };
	all.insert(all.end(), pendingWork.begin(), pendingWork.end());
	all.insert(all.end(), { lastTimeStep, Real(flowClock.steps), flowClock.time });
	for (const auto& [id, point] : nodes)
		writePoint(all, id, point);
	for (const auto& [id, core] : cores) {
		writePoint(all, id, core);
		all.insert(all.end(), { Real(core.spins), core.angle, core.spin, core.moment, core.lastSpin });
		const auto memory = memories.find(id);
		all.push_back(memory == memories.end() ? 0 : Real(memory->second.fields + 1));
		if (memory != memories.end())
			all.insert(all.end(), memory->second.numbers.begin(), memory->second.numbers.end());
	}
	return to;
}

StateStore StateStore::fromSaved(const Saved& saved, std::size_t works)
{
	StateStore store;
	for (const std::string& line : saved.names) {
		Fields             kind;
		std::istringstream words(line);
		for (std::string word; words >> word;) {
			const auto colon = word.find(':');
			if (colon == std::string::npos || colon + 2 != word.size() || !std::isdigit(word.back()))
				damaged("has the unreadable field '" + word + "'");
			kind.names.push_back(word.substr(0, colon));
			kind.components.push_back(std::size_t(word.back() - '0'));
			kind.numbers += kind.components.back();
		}
		store.kinds.push_back(kind);
	}
	NumberReader from(saved.numbers);
	const auto   nNodes = from.count(), nCores = from.count();
	for (std::size_t i = 0; i < works; i++)
		store.pendingWork[i] = from.next();
	store.lastTimeStep    = from.next();
	store.flowClock.steps = unsigned(from.next());
	store.flowClock.time  = from.next();
	for (std::size_t i = 0; i < nNodes; i++)
		readPoint(from, store.nodes[Body::id_t(from.next())]);
	for (std::size_t i = 0; i < nCores; i++) {
		const auto id   = Body::id_t(from.next());
		Core&      core = store.cores[id];
		readPoint(from, core);
		core.spins = from.next() != 0;
		for (auto* value : { &core.angle, &core.spin, &core.moment, &core.lastSpin })
			*value = from.next();
		const std::size_t kind = from.count();
		if (kind == 0) continue;
		if (kind > store.kinds.size()) damaged("has fields without names");
		Memory& memory = store.memories[id];
		memory.fields  = kind - 1;
		for (std::size_t j = 0; j < 3 * store.kinds[kind - 1].numbers; j++)
			memory.numbers.push_back(from.next());
	}
	if (!from.atEnd()) damaged("is too long");
	return store;
}

} // namespace yade
