// GPL v2 or later, see LICENSE.
// The group of triangles of one law: everything that is the same for all laws, written once. Included by the files that
// LawGroups.cpp.in makes, one for each law.
#pragma once

#include <pkg/ddem/kernel/triangles/LawGroup.hpp>

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace yade::ddem {

namespace detail {

	/// Calls use(std::integral_constant<unsigned, mask>) for the distinct mask that a mask known at run time
	/// amounts to.
	template <class Law, class Use, std::size_t... masks>
	auto withMask(unsigned effects, Use&& use, std::index_sequence<masks...>)
	{
		using Result       = decltype(use(std::integral_constant<unsigned, 0>()));
		using Call         = Result (*)(Use&);
		static constexpr Call calls[] = { [](Use& u) -> Result {
			return u(std::integral_constant<unsigned, Law::distinct(unsigned(masks))>());
		}... };
		return calls[effects](use);
	}

	struct ListProperties {
		std::vector<std::pair<const char*, const char*>> list; ///< name, unit

		void operator()(const char* name, const char* unit, double&) { list.emplace_back(name, unit); }
	};
	struct PropertyValues {
		std::vector<double> list;

		void operator()(const char*, const char*, double& value) { list.push_back(value); }
	};
	struct SetProperties {
		const double* from;

		void operator()(const char*, const char*, double& to) { to = *from++; }
	};

} // namespace detail

/// Calls use with the mask as a compile-time constant.
template <class Law, class Use> auto withMask(unsigned effects, Use&& use)
{
	if (effects > Law::allEffects)
		throw std::invalid_argument("unknown effect in the mask " + std::to_string(effects));
	return detail::withMask<Law>(effects, use, std::make_index_sequence<Law::allEffects + 1>());
}

template <class Law> class GroupOf : public LawGroup {
public:
	using State      = typename Law::template State<double>;
	using Properties = typename Law::template Properties<double>;

	GroupOf(const typename Law::Parameters& parameters, unsigned wanted)
	        : prepared(parameters)
	        , on(wanted & ~unsigned(LawEffects::Energy))
	        , layout(on)
	{
		if (wanted > Law::allEffects)
			throw std::invalid_argument(
			        std::string(Law::name) + ": unknown effect in the mask " + std::to_string(wanted)
			        + "; the largest mask is " + std::to_string(Law::allEffects));
		listFields();
		detail::ListProperties list;
		withMask<Law>(on, [&](auto mask) {
			Properties any {};
			Law::template properties<mask()>(any, list);
		});
		propertyNames = list.list;
		if (propertyNames.size() > mostProperties)
			throw std::logic_error("a law has more properties than mostProperties");
		own.resize(propertyNames.size());
		prepare(RotationTreatment::Cosserat);
	}

	std::unique_ptr<LawGroup>     clone() const override { return std::make_unique<GroupOf>(*this); }
	const char*                   name() const override { return Law::name; }
	const std::vector<LawEffect>& effectsOfLaw() const override { return Law::effects(); }
	unsigned                      effects() const override { return on; }
	TriangleStiffness             stiffness() const override
	{
		const auto& p = prepared.parameters;
		return { p.bulk, p.shear, p.rotationStiffness };
	}
	bool stiffensInRuns() const override { return Law::stiffens(on); }

	void start(const std::vector<TriangleProperties>& all) override
	{
		if (all.size() != triangles()) throw std::logic_error("LawGroup: every triangle needs its properties");
		columns.resize(triangles(), columnsOf(layout));
		const bool stressed = std::any_of(all.begin(), all.end(), [](const TriangleProperties& t) {
			return norm(t.initialStress[0]) + norm(t.initialStress[1]) + norm(t.initialStress[2]) != 0;
		});
		initial.resize(stressed ? triangles() : 0, 4);
		std::vector<std::vector<double>> values(own.size());
		for (std::size_t i = 0; i < all.size(); i++) {
			Properties mine {};
			std::array<State, 3> first {};
			try {
				mine = Law::propertiesOf(prepared, all[i]);
				first.fill(Law::virgin(prepared, all[i]));
				for (std::size_t k = 0; stressed && k < 3; k++)
					setInitialStrain(i, k, beginAtStress(mine, all[i].initialStress[k], first[k]));
			} catch (const std::invalid_argument& error) {
				throw RefusedTriangle(i, error.what());
			}
			detail::PropertyValues list;
			withMask<Law>(on, [&](auto mask) { Law::template properties<mask()>(mine, list); });
			for (std::size_t p = 0; p < own.size(); p++)
				values[p].push_back(list.list[p]);
			for (std::size_t k = 0; k < 3; k++)
				store(i, k, first[k]);
		}
		initial.fillUp();
		propertyBytes = initial.bytes();
		for (std::size_t p = 0; p < own.size(); p++) {
			std::vector<double>& v = values[p];
			// one value for all takes no room for each
			const bool uniform = std::all_of(v.begin(), v.end(), [&](double x) { return x == v.front(); });
			const double last = v.empty() ? 0 : v.back();
			own[p].step       = uniform ? 0 : 1;
			v.resize(uniform ? widestBatch : columns.paddedRows(), last);
			own[p].values.assign(v.begin(), v.end());
			if (!uniform) propertyBytes += triangles() * sizeof(double);
		}
		fillUp();
	}

	void keepBook(bool energy, const StrainOf& strainOf) override
	{
		if (energy == book) return;
		book = energy;
		pick();
		if (!energy) { // what the book had stays, and its columns, which come last
			stateIsNew(); // nobody has looked at thresholds meanwhile
			return;
		}
		if (!(layout & LawEffects::Energy)) {
			const StateColumns old = columns;
			layout                 = on | LawEffects::Energy;
			listFields();
			columns.resize(triangles(), columnsOf(layout));
			for (std::size_t i = 0; i < triangles(); i++)
				for (std::size_t k = 0; k < 3; k++)
					for (std::size_t c = 0; c < old.columns(); c++)
						columns.row(i, k)[c * columns.columnStep(i)]
						        = old.row(i, k)[c * old.columnStep(i)];
		}
		for (std::size_t i = 0; i < triangles(); i++) {
			const auto strain = strainOf(i);
			for (std::size_t k = 0; k < 3; k++) {
				State s = load(i, k);
				withMask<Law>(layout, [&](auto mask) {
					Law::template openBook<mask()>(prepared, strain[k] + initialStrain(i, k), s);
				});
				store(i, k, s);
			}
		}
		columns.fillUp();
	}

	void
	beginAt(std::size_t i, const std::set<std::string>& missing, const std::array<PlaneTensor, 3>& strain) override
	{
		const ListFields ofLaw  = fieldsOf(on); // without the book's
		const bool lawNew = std::any_of(ofLaw.list.begin(), ofLaw.list.end(), [&](const StateField& f) {
			return missing.count(f.name) > 0;
		});
		for (std::size_t k = 0; k < 3; k++) {
			State s = load(i, k);
			if (lawNew)
				withMask<Law>(on, [&](auto mask) {
					Law::template beginAt<mask()>(strain[k] + initialStrain(i, k), s);
				});
			if (book && !missing.empty())
				withMask<Law>(layout, [&](auto mask) {
					Law::template openBook<mask()>(prepared, strain[k] + initialStrain(i, k), s);
				});
			store(i, k, s);
		}
	}

	void prepare(RotationTreatment newRotation, bool newWidest) override
	{
		rotation = newRotation;
		widest   = newWidest;
		pick();
	}

	void advance(std::size_t tile, const ElementArrays& arrays, double dt, StepEnergy& sum) override
	{
		TileState<Law> t { &prepared, columns.tile(tile), columns.stride(tile), {}, {}, held, nullptr };
		if (initial.triangles()) t.initialStrain = initial.tile(tile);
		for (std::size_t p = 0; p < own.size(); p++) {
			t.propertyStep[p] = own[p].step;
			t.property[p]     = own[p].values.data() + own[p].step * tile * tileSize;
		}
		const std::size_t first = begin + tile * tileSize;
		const std::size_t last  = std::min(first + tileSize, end);
		if constexpr (Law::hasThreshold(Law::allEffects)) {
			if (loops.below && untouched[tile] && loops.below(arrays, constants, t, dt, first, last, sum))
				return;
			untouched[tile] = false;
		}
		loops.law(arrays, constants, t, dt, first, last, sum);
	}

	std::array<PlaneTensor, 3>
	stress(std::size_t triangle, const std::array<PlaneTensor, 3>& strain, double dt) const override
	{
		std::array<PlaneTensor, 3> result {};
		const Properties           mine = propertiesOf(triangle);
		for (std::size_t k = 0; k < 3; k++) {
			State s = load(triangle, k);
			withMask<Law>(on, [&](auto mask) {
				double time = dt;
				if constexpr (Law::holds(mask()))
					if (Law::template flowMayWait<mask()>(prepared, s)) time += flowClock.time;
				result[k] = Law::template advance<mask()>(
				        prepared, mine, strain[k] + initialStrain(triangle, k), time, s);
			});
		}
		return result;
	}

	std::array<double, 3> damage(std::size_t triangle) const override
	{
		std::array<double, 3> result {};
		if (!Law::damages(on)) return result;
		const Properties mine = propertiesOf(triangle);
		for (std::size_t k = 0; k < 3; k++)
			result[k] = Law::damage(prepared, mine, load(triangle, k));
		return result;
	}

	double stiffening(std::size_t triangle) const override
	{
		if (!Law::stiffens(on)) return 1;
		double largest = 1;
		for (std::size_t k = 0; k < 3; k++)
			largest = std::max(largest, Law::stiffening(prepared, load(triangle, k)));
		return largest;
	}

	double property(const std::string& wanted, std::size_t triangle) const override
	{
		for (std::size_t p = 0; p < own.size(); p++)
			if (propertyNames[p].first == wanted) return own[p].values[own[p].step * triangle];
		return 0;
	}

private:
	struct Property {
		std::vector<double, xsimd::aligned_allocator<double, 64>> values;
		std::size_t                                               step = 0;
	};
	typename Law::Prepared                           prepared;
	unsigned                                         on;     ///< effects without the book
	unsigned                                         layout; ///< mask that the columns are for
	bool                                             book     = false;
	RotationTreatment                                rotation = RotationTreatment::Cosserat;
	bool                                             widest   = true;
	TileLoops<Law>                                   loops;
	StateColumns      initial;   ///< strain xx, yy, zz, xy of initial stresses; empty where there are none
	std::vector<char> untouched; ///< tiles that have not left it; empty for laws without threshold
	std::vector<Property>                            own;
	std::vector<std::pair<const char*, const char*>> propertyNames;

	void pick() { loops = selectTileLoops<Law>(on | (book ? unsigned(LawEffects::Energy) : 0), rotation, widest); }
	void prepare(RotationTreatment newRotation) { prepare(newRotation, true); }

	void stateIsNew() override
	{
		if constexpr (!Law::hasThreshold(Law::allEffects)) return;
		if (initial.triangles()) { // thresholds are those of strain from nothing
			untouched.assign(tiles(), false);
			return;
		}
		State               virgin = Law::virgin(prepared, TriangleProperties());
		std::vector<double> number(columnsOf(on)); // without what only the book has, which comes last
		withMask<Law>(on, [&](auto mask) {
			Law::template fields<mask()>(virgin, StoreFields<double> { number.data(), 1 });
		});
		untouched.assign(tiles(), true);
		for (std::size_t i = 0; i < triangles(); i++)
			for (std::size_t k = 0; k < 3; k++)
				for (std::size_t c = 0; c < number.size(); c++)
					if (!(columns.row(i, k)[c * columns.columnStep(i)] == number[c]))
						untouched[i / tileSize] = false;
	}

	PlaneTensor initialStrain(std::size_t triangle, std::size_t k) const
	{
		if (!initial.triangles()) return {};
		const double*     first = initial.row(triangle, k);
		const std::size_t step  = initial.columnStep(triangle);
		return { first[0], first[step], first[2 * step], first[3 * step] };
	}
	void setInitialStrain(std::size_t triangle, std::size_t k, const PlaneTensor& strain)
	{
		double* const     first = initial.row(triangle, k);
		const std::size_t step  = initial.columnStep(triangle);
		first[0]                = strain.xx;
		first[step]             = strain.yy;
		first[2 * step]         = strain.zz;
		first[3 * step]         = strain.xy;
	}
	/// Strain at which a state that begins there has a stress [Pa]; it becomes that state.
	/// \throws std::invalid_argument if the law does not bear the stress.
	PlaneTensor beginAtStress(const Properties& mine, const PlaneTensor& wanted, State& state) const
	{
		const TriangleStiffness moduli     = stiffness();
		const auto              compliance = [&](const PlaneTensor& stress) {
                        const double mean = trace(stress) / 3, all = mean / (3 * moduli.bulk);
                        const double shear = 1 / (2 * moduli.shear);
                        return PlaneTensor { shear * (stress.xx - mean) + all, shear * (stress.yy - mean) + all,
                                             shear * (stress.zz - mean) + all, shear * stress.xy };
		};
		constexpr int    mostRounds = 200;
		constexpr double exact      = 1e-14; // of the stress; a few roundings
		if (norm(wanted) == 0) return {};
		PlaneTensor strain = compliance(wanted), reached {};
		double      best   = norm(wanted);
		for (int round = 0; round < mostRounds; round++) {
			State now = state;
			withMask<Law>(on, [&](auto mask) {
				Law::template beginAt<mask()>(strain, now);
				reached = Law::template advance<mask()>(prepared, mine, strain, 1., now);
			});
			const PlaneTensor missing = wanted - reached;
			const double      off     = norm(missing);
			// as near as rounding lets it come
			if (off <= exact * norm(wanted) || (off <= 100 * exact * norm(wanted) && off >= best)) {
				state = now;
				return strain;
			}
			best   = std::min(best, off);
			strain = strain + compliance(missing);
		}
		std::ostringstream text;
		text << "initialStress (xx, yy, zz, xy) = (" << wanted.xx << ", " << wanted.yy << ", " << wanted.zz
		     << ", " << wanted.xy << ") Pa is more than its law " << Law::name << " bears, which comes to ("
		     << reached.xx << ", " << reached.yy << ", " << reached.zz << ", " << reached.xy
		     << ") Pa; give a smaller stress, or a stronger material";
		throw std::invalid_argument(text.str());
	}

	static ListFields fieldsOf(unsigned mask)
	{
		ListFields list;
		withMask<Law>(mask, [&](auto constant) {
			State s {};
			Law::template fields<constant()>(s, list);
		});
		return list;
	}
	static std::size_t columnsOf(unsigned mask) { return fieldsOf(mask).columns; }
	void               listFields() { fieldList = fieldsOf(layout).list; }

	State load(std::size_t triangle, std::size_t k) const
	{
		State s {};
		withMask<Law>(layout, [&](auto mask) {
			Law::template fields<mask()>(
			        s, LoadFields<double> { columns.row(triangle, k), columns.columnStep(triangle),
				                     initialStrain(triangle, k).zz });
		});
		return s;
	}
	void store(std::size_t triangle, std::size_t k, State& s)
	{
		withMask<Law>(layout, [&](auto mask) {
			Law::template fields<mask()>(
			        s, StoreFields<double> { columns.row(triangle, k), columns.columnStep(triangle) });
		});
	}
	void store(std::size_t triangle, std::size_t k, const State& s)
	{
		State copy = s;
		store(triangle, k, copy);
	}
	Properties propertiesOf(std::size_t triangle) const
	{
		double values[mostProperties] = {};
		for (std::size_t p = 0; p < own.size(); p++)
			values[p] = own[p].values[own[p].step * triangle];
		Properties mine {};
		detail::SetProperties set { values };
		withMask<Law>(on, [&](auto mask) { Law::template properties<mask()>(mine, set); });
		return mine;
	}
};

template <class Law> std::unique_ptr<LawGroup> makeGroup(const typename Law::Parameters& parameters, unsigned effects)
{
	return std::make_unique<GroupOf<Law>>(parameters, effects);
}

} // namespace yade::ddem
