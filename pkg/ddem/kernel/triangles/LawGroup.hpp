// GPL v2 or later, see LICENSE.
// A group of triangles that share one law, whatever it is.
#pragma once

#include <pkg/ddem/kernel/algebra/Parameters.hpp>
#include <pkg/ddem/kernel/triangles/LawLoops.hpp>
#include <pkg/ddem/kernel/triangles/StableStep.hpp>
#include <pkg/ddem/kernel/triangles/StateColumns.hpp>

#include <array>
#include <functional>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace yade::ddem {

/// What a triangle may tell its law beside its strain.
struct TriangleProperties {
	double      area           = 0;  ///< reference area [m²]
	double      fractureEnergy = -1; ///< of its own; negative: the material's, in the unit that its law says
	double      bandFactor     = 1;  ///< of a crack band, on the fracture energy once flow has localised [-]
	PlaneTensor initialDamage { 0, 0, 0, 0 };
	std::array<PlaneTensor, 3> initialStress {}; ///< of the sub-elements, where they are not strained [Pa]

	TriangleProperties() = default;
	TriangleProperties(double area_, double fractureEnergy_, double bandFactor_, const PlaneTensor& initialDamage_)
	        : area(area_)
	        , fractureEnergy(fractureEnergy_)
	        , bandFactor(bandFactor_)
	        , initialDamage(initialDamage_)
	{
	}
};

/// A triangle that its law refuses.
struct RefusedTriangle : std::invalid_argument {
	std::size_t triangle; ///< counted from the group's first

	RefusedTriangle(std::size_t triangle_, const char* why)
	        : std::invalid_argument(why)
	        , triangle(triangle_)
	{
	}
};

/// A part of a law that a scene can leave out.
struct LawEffect {
	unsigned    bit;
	const char* name; ///< of the switch in the material
	const char* doc;
};

/// An entry of effects() from a law's list of effects, E(switch, bit, doc).
#define DDEM_LAW_EFFECT(name, bit, doc) { unsigned(bit), #name, doc },

/** What most laws have in common; a law derives from it and says only what is different. A law has no state of its
 * own. It gives, beside these: name; Parameters with its list, Prepared made of them (which checks them); State of
 * a sub-element and its fields(); virgin(); advance(); energies(). See Elastic and ScalarDamage, and the manual's
 * page on a new law. */
struct LawDefaults {
	/// Mask of all effects, with the book.
	static constexpr unsigned allEffects = LawEffects::Energy;
	/// Masks that do the same are one.
	static constexpr unsigned distinct(unsigned effects) { return effects; }
	/// Whether the law without any of its effects is plain elasticity, and may run as that.
	static constexpr bool elasticWithoutEffects = false;
	/// Whether the moduli can grow above the initial ones (stiffening() then tells by how much).
	static constexpr bool stiffens(unsigned) { return false; }
	/// Whether it may turn work into heat or cracks; else energies() of the two are not added up.
	static constexpr bool dissipates(unsigned) { return true; }
	/// Whether it can break (damage() then tells how much).
	static constexpr bool                damages(unsigned) { return false; }
	static const std::vector<LawEffect>& effects()
	{
		static const std::vector<LawEffect> none;
		return none;
	}
	/// The effects of a mask that do anything with these parameters.
	template <class Parameters> static unsigned effective(const Parameters&, unsigned effects) { return effects; }

	/// Numbers that a triangle has of its own, at most mostProperties.
	template <class Number> struct Properties { };
	template <unsigned effects, class P, class Visit> static void properties(P&, Visit&&) { }
	template <class Prepared> static Properties<double> propertiesOf(const Prepared&, const TriangleProperties&)
	{
		return {};
	}

	/// Whether it may be held: see LawLoops.hpp. Then it has
	///     hold<effects>(law, own, strain, state): the stress of a held step,
	///     evaluatedStrain(state): the strain of the last evaluation,
	///     flowMayWait<effects>(law, state): where flow may wait, see LawGroup::flowInterval,
	///     bookHeld<effects>(strain, stress, state): with the book, keeps what it needs of a held step.
	static constexpr bool holds(unsigned) { return false; }
	/// Whether a virgin sub-element is plainly elastic below a threshold, with moduli law.lambda and law.twoShear,
	/// and keeps its state there (but for what only the book needs). Then it has
	///     beyondThreshold<effects>(law, own, strain): where elastic stress may no longer do; strain has no zz.
	static constexpr bool hasThreshold(unsigned) { return false; }

	/// Called where a law begins in the midst of a run, at this strain:
	/// its state is virgin but for what it knew before.
	template <unsigned effects, class State> static void beginAt(const PlaneTensor&, State&) { }
	/// Called when the energy book is opened: fields that only the book has get their values.
	template <unsigned effects, class Prepared, class State>
	static void openBook(const Prepared&, const PlaneTensor&, State&)
	{
	}

	template <class Prepared, class State>
	static double damage(const Prepared&, const Properties<double>&, const State&)
	{
		return 0;
	}
	template <class Prepared, class State> static double stiffening(const Prepared&, const State&) { return 1; }
};

/** Consecutive triangles of one law: their parameters and their state. Asked once for a tile, never for one
 * triangle, in a step. Triangles are counted from the group's first. */
class LawGroup {
public:
	std::size_t    begin = 0, end = 0; ///< rows in the system
	GroupConstants constants;

	/** Bound on the change of strain of a sub-element at rest, as a multiple of the round-off that its strain
	 * carries; see LawLoops.hpp. 0: only strains that are equal to the last bit; negative: no rest. */
	double rest = 4;
	/** Steps from one solution of flow to the next; in those between, stress is elastic (held, see
	 * LawLoops.hpp). The step that solves it takes the whole strain since the last solution, and the whole
	 * time. Sub-elements with damage above a small bound that their law states do not wait: each of their steps
	 * solves it.
	 *
	 * Error for monotone strain: at most M m Δε of stress, m the interval, Δε the largest strain of a step, M
	 * the largest elastic modulus, λ + 2μ. Why: along such a path stress follows σ' = M (1 − g(σ)), with g ≥ 0
	 * growing with σ, so two solutions approach each other; an implicit step of strain h adds an error of at
	 * most h times the variation of σ' within it, and σ' falls from M to zero at most once: at most M h in all,
	 * from below, for h = m Δε. (One step at a time errs on the same side, so the difference is less.) A held
	 * step lies above: the predictor has done without flow for at most m − 1 steps, which is at most M (m − 1)
	 * Δε. Each reversal of strain adds the same once more, and fades with the strain that follows. Measured for
	 * m = 2, 4 and 8 (flow_interval_test): 0.16 to 0.27 of the bound in slow compression, 0.06 to 0.1 of twice the
	 * bound in cycles, 0.12 to 0.2 in a ramp to 10²/s. */
	unsigned flowInterval = 1;
	/// What has gone by since flow was last solved, as far as it waits. Saved with a sample, so that it goes on
	/// with the same bits.
	struct FlowClock {
		unsigned steps = 0;
		double   time  = 0; ///< [s]
	} flowClock;

	virtual ~LawGroup() = default;
	virtual std::unique_ptr<LawGroup> clone() const = 0;

	// --- what it is
	virtual const char*                   name() const              = 0; ///< of the law
	virtual const std::vector<LawEffect>& effectsOfLaw() const      = 0; ///< all that the law has
	virtual unsigned                      effects() const           = 0; ///< those that are on
	virtual TriangleStiffness             stiffness() const         = 0; ///< at no pressure, without damage
	virtual bool                          stiffensInRuns() const    = 0; ///< whether stiffening() may exceed 1

	// --- state
	/** Virgin state of so many triangles, from `begin` to `end`.
	 *
	 * Where they have an initial stress, their law sees strain + ε_0, with ε_0 such that it gives that stress
	 * at no strain: found by the elastic compliance S, ε_0 ← ε_0 + S:(σ_0 − σ(ε_0)), from a law that begins at
	 * ε_0. So it works with every law, which takes the stress for its own, and costs nothing elsewhere.
	 * \throws std::logic_error unless there is one entry for each; RefusedTriangle for what the law cannot
	 * have, also an initial stress that it does not bear. */
	virtual void start(const std::vector<TriangleProperties>& triangles) = 0;
	using StrainOf = std::function<std::array<PlaneTensor, 3>(std::size_t triangle)>;
	/// Opens the energy book, which begins with the present strains, or leaves it.
	virtual void keepBook(bool energy, const StrainOf& strain) = 0;
	/// In the midst of a run, at the present strain:
	/// `missing` fields of a triangle have just begun to be remembered.
	virtual void beginAt(
	        std::size_t triangle, const std::set<std::string>& missing, const std::array<PlaneTensor, 3>& strain)
	        = 0;
	std::size_t  triangles() const { return end - begin; }
	/// The one list of what a sub-element remembers.
	const std::vector<StateField>& fields() const { return fieldList; }
	/// \returns null where this group has none of that name.
	const StateField* field(const std::string& name) const;
	/// Components of a field, 1, 3 or 4 numbers.
	void get(const StateField&, std::size_t triangle, std::size_t k, double* to) const;
	void set(const StateField&, std::size_t triangle, std::size_t k, const double* from);
	/// To be called after the last set().
	void fillUp()
	{
		columns.fillUp();
		stateIsNew();
	}
	/// Bytes that the state of a triangle takes: its columns, and what it has of its own.
	std::size_t         bytesPerTriangle() const;
	const StateColumns& state() const { return columns; }

	// --- what it does
	/// Picks the loop for a treatment of rotation. `widest` false takes the instructions that every processor has.
	virtual void prepare(RotationTreatment rotation, bool widest = true) = 0;
	/// To be called before the tiles of a step, and after them.
	void beginStep(double dt);
	void endStep();
	/// One step of a tile; see TileLoop. The arrays' rows are those of the system.
	virtual void advance(std::size_t tile, const ElementArrays&, double dt, StepEnergy&) = 0;
	std::size_t  tiles() const { return tilesOf(triangles()); }
	/// Stress that the law gives to the strains after another dt [s], from the present state, which stays as it is;
	/// flow that waits is solved [Pa].
	virtual std::array<PlaneTensor, 3>
	stress(std::size_t triangle, const std::array<PlaneTensor, 3>& strain, double dt) const = 0;
	/// Damage of the sub-elements [-], 0 intact to 1.
	virtual std::array<double, 3> damage(std::size_t triangle) const = 0;
	/// Largest factor on the moduli in the present state, ≥ 1, for the time step [-].
	virtual double stiffening(std::size_t triangle) const = 0;
	/// A number of the triangle's own by its name (properties() of the law).
	virtual double property(const std::string& name, std::size_t triangle) const = 0;

protected:
	virtual void stateIsNew() { } ///< called when it was not made by steps

	HeldSteps               held; ///< of this step
	StateColumns            columns;
	std::vector<StateField> fieldList;
	std::size_t             propertyBytes = 0; ///< of all triangles
};

/// A group pointer that copies what it points to.
class GroupPointer {
public:
	GroupPointer(std::unique_ptr<LawGroup> made) // NOLINT: a group is meant to become one
	        : group(std::move(made))
	{
	}
	GroupPointer(const GroupPointer& other)
	        : group(other.group->clone())
	{
	}
	GroupPointer(GroupPointer&&) = default;
	GroupPointer& operator=(GroupPointer other)
	{
		group = std::move(other.group);
		return *this;
	}
	LawGroup&       operator*() { return *group; }
	const LawGroup& operator*() const { return *group; }
	LawGroup*       operator->() { return group.get(); }
	const LawGroup* operator->() const { return group.get(); }

private:
	std::unique_ptr<LawGroup> group;
};

/// An empty group of a law; `effects` is a mask of what is on beside the energy book.
/// \throws std::invalid_argument for a parameter out of bounds or an unknown effect.
template <class Law> std::unique_ptr<LawGroup> makeGroup(const typename Law::Parameters& parameters, unsigned effects);

} // namespace yade::ddem
