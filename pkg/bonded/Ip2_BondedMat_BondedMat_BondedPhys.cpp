// GPL v2 or later, see LICENSE.
// From two materials to a contact or a bond.
#include <pkg/bonded/Ip2_BondedMat_BondedMat_BondedPhys.hpp>
#include <pkg/bonded/BondedInteractionLoop.hpp>
#include <pkg/ddem/SingleProcess.hpp>

#include <limits>
#include <map>
#include <set>
#include <sstream>

namespace yade {

DDEM_PLUGIN((Ip2_BondedMat_BondedMat_BondedPhys)(Ip2_FrictMat_BondedMat_BondedPhys))

namespace {

	/// Forces on a grid's connection belong to its nodes, which this law does not know.
	void refuseGrid(Scene& scene, const Interaction& I)
	{
		if (I.geom->getClassName() != "ScGridCoGeom") return;
		stopAfterStep(
		        scene,
		        "bodies #" + std::to_string(I.getId1()) + " and #" + std::to_string(I.getId2())
		                + ": BondedMat has no contact with grid connections and PFacets; give these bodies "
		                  "another mask, or use Facet");
	}

	struct Particle {
		Body*            body;
		const Sphere*    sphere;
		const BondedMat* material;
	};

	[[noreturn]] void refuse(const Vector2i& pair, const std::string& why)
	{
		std::ostringstream text;
		text << "cannot bond bodies #" << pair[0] << " and #" << pair[1] << ": " << why;
		throw std::invalid_argument(text.str());
	}

	Particle checkedParticle(const Scene& scene, const Vector2i& pair, int id)
	{
		const std::string name = "#" + std::to_string(id);
		if (id < 0 || id >= int(scene.bodies->size()) || !(*scene.bodies)[id])
			refuse(pair, "there is no body " + name);
		Body*          body = (*scene.bodies)[id].get();
		const Particle particle { body, dynamic_cast<const Sphere*>(body->shape.get()),
			                  dynamic_cast<const BondedMat*>(body->material.get()) };
		if (!particle.sphere) refuse(pair, name + " is not a sphere");
		if (!particle.material) refuse(pair, name + " has no BondedMat");
		if (!(particle.sphere->radius > 0) || !std::isfinite(particle.sphere->radius))
			refuse(pair,
			       "radius of " + name + " = " + std::to_string(particle.sphere->radius)
			               + " m must be positive and finite");
		if (!body->state->pos.allFinite()) refuse(pair, "position of " + name + " is not finite");
		return particle;
	}

	bool isBonded(const shared_ptr<Interaction>& interaction)
	{
		const auto* phys = interaction ? dynamic_cast<const BondedPhys*>(interaction->phys.get()) : nullptr;
		return phys && phys->bonded;
	}

	/// Period of the cell in which the second of two bodies is closest to the first; none without a cell.
	Vector3i nearestPeriod(const Scene& scene, const Vector3r& branch)
	{
		Vector3i nearest = Vector3i::Zero();
		if (!scene.isPeriodic) return nearest;
		const Vector3r periods = -(scene.cell->hSize.inverse() * branch);
		const Vector3i around(
		        int(std::lround(periods[0])), int(std::lround(periods[1])), int(std::lround(periods[2])));
		Real           least = std::numeric_limits<Real>::infinity();
		for (int k = 0; k < 27; k++) { // in a sheared cell it may be one further
			const Vector3i tried  = around + Vector3i(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
			const Real     length = (branch + scene.cell->intrShiftPos(tried)).norm();
			if (length < least) std::tie(least, nearest) = std::make_pair(length, tried);
		}
		return nearest;
	}

	/// In a narrow cell a bond could as well go to another image.
	void requireRoom(const Scene& scene, const Vector2i& pair, Real length)
	{
		const Matrix3r across = scene.cell->hSize.inverse(); // a row is one over the height across two sides
		const Real     height = 1 / across.rowwise().norm().maxCoeff();
		if (2 * length < height) return;
		std::ostringstream text;
		text << "they are " << length << " m apart, which is half or more of the periodic cell's " << height
		     << " m: make the cell wider, or the spheres smaller";
		refuse(pair, text.str());
	}

	/// Geometry of the pair, as Ig2_Sphere_Sphere_ScGeom or …6D would have made it and will update it.
	/// \param branch from the centre of one to that of the other, or of its periodic image
	shared_ptr<ScGeom6D> makeGeometry(
	        const Particle& a, const Particle& b, const Scene& scene, const shared_ptr<Interaction>& interaction,
	        const Vector3r& branch)
	{
		const Real     distance = branch.norm();
		const Vector3r shift    = branch - (b.body->state->pos - a.body->state->pos);
		auto           geom     = boost::make_shared<ScGeom6D>();
		geom->radius1           = a.sphere->radius;
		geom->radius2           = b.sphere->radius;
		geom->penetrationDepth  = geom->radius1 + geom->radius2 - distance;
		geom->contactPoint
		        = a.body->state->pos + (geom->radius1 - geom->penetrationDepth / 2) / distance * branch;
		geom->precompute(*a.body->state, *b.body->state, &scene, interaction, branch / distance, true, shift);
		geom->initRotations(*a.body->state, *b.body->state);
		return geom;
	}

	/// What breaks bonds of two materials.
	struct Breaking {
		const ddem::BondCriterion*  criterion;
		ddem::BondCriterion::Values values;
	};

	/// That of every pair of materials, found once.
	class Strengths {
	public:
		explicit Strengths(const Scene& of) : scene(of) { }

		/// \throws std::invalid_argument for materials that are no good, or whose criteria differ
		const Breaking& of(const BondedMat& a, const BondedMat& b)
		{
			const auto [place, fresh] = known.try_emplace({ &a, &b });
			if (fresh) {
				try {
					place->second = make(a, b);
				} catch (...) {
					known.erase(place);
					throw;
				}
			}
			return place->second;
		}

	private:
		Breaking make(const BondedMat& a, const BondedMat& b) const
		{
			for (const BondedMat* material : { &a, &b })
				material->validate();
			if (const BondedMat* between = materialBetween(scene, a, b)) {
				between->validate();
				const CriterionOfMaterial own = between->ownCriterion();
				return { own.criterion, own.values };
			}
			const CriterionOfMaterial first = a.ownCriterion(), second = b.ownCriterion();
			if (first.criterion != second.criterion)
				throw std::invalid_argument(
				        "'" + a.label + "' breaks by " + first.criterion->name() + ", '" + b.label
				        + "' by " + second.criterion->name() + ": append a third material between=['"
				        + a.label + "', '" + b.label + "'] that says what their bonds bear");
			return { first.criterion, first.criterion->weaker(first.values, second.values) };
		}
		const Scene&                                                       scene;
		std::map<std::pair<const BondedMat*, const BondedMat*>, Breaking> known;
	};

	/// A bond that passed all checks.
	struct Planned {
		Planned(const Particle& first, const Particle& second, const shared_ptr<BondedPhys>& made,
		        const Breaking& breaking, const ddem::BondMaking& making, Real factor, const Vector3i& inPeriod,
		        const Vector3r& between)
		        : a(first)
		        , b(second)
		        , phys(made)
		        , criterion(breaking.criterion)
		        , strength(criterion->strengthOf(
		                  factor == 1 ? breaking.values : criterion->scaled(breaking.values, factor), making))
		        , radius(criterion->radius(breaking.values, making))
		        , period(inPeriod)
		        , branch(between)
		{
		}
		Particle                   a, b;
		shared_ptr<BondedPhys>     phys;
		const ddem::BondCriterion* criterion;
		ddem::BondStrength         strength;
		Real                       radius; ///< of the section [m]
		Vector3i                   period; ///< of the cell in which the second is meant
		Vector3r                   branch; ///< to it
	};

	std::vector<Real> checkedFactors(const boost::python::object& given, size_t count)
	{
		if (given.is_none()) return {};
		const boost::python::stl_input_iterator<Real> begin(given), end;
		std::vector<Real>                             factors(begin, end);
		if (factors.size() != count)
			throw std::invalid_argument(
			        "bond: " + std::to_string(factors.size()) + " factors for " + std::to_string(count)
			        + " pairs; there must be one for each");
		for (size_t i = 0; i < count; i++)
			if (!(factors[i] > 0) || !std::isfinite(factors[i]))
				throw std::invalid_argument(
				        "bond: factor " + std::to_string(i) + " = " + std::to_string(factors[i])
				        + " [-] must be positive and finite");
		return factors;
	}

} // namespace

void Ip2_BondedMat_BondedMat_BondedPhys::go(
        const shared_ptr<Material>& material1, const shared_ptr<Material>& material2,
        const shared_ptr<Interaction>& interaction)
{
	if (interaction->phys) return;
	refuseGrid(*scene, *interaction);
	const auto &     a = static_cast<const BondedMat&>(*material1), &b = static_cast<const BondedMat&>(*material2);
	const BondedMat* between = nullptr;
	try {
		between = materialBetween(*scene, a, b);
	} catch (const std::invalid_argument& error) { // what is thrown in the loop of InteractionLoop ends the program
		stopAfterStep(*scene, error.what());
	}
	interaction->phys = BondedPhys::contact(a, b, between, BondedPhys::reachOf(*interaction));
}

void Ip2_FrictMat_BondedMat_BondedPhys::go(
        const shared_ptr<Material>& material1, const shared_ptr<Material>& material2,
        const shared_ptr<Interaction>& interaction)
{
	if (interaction->phys) return;
	refuseGrid(*scene, *interaction);
	const auto* bonded = dynamic_cast<const BondedMat*>(material1.get()); // they come in either order
	const auto& other  = static_cast<const FrictMat&>(bonded ? *material2 : *material1);
	if (!bonded) bonded = static_cast<const BondedMat*>(material2.get());
	BondedMat like       = *bonded;
	like.young           = other.young;
	like.frictionStatic  = math::tan(other.frictionAngle);
	like.frictionDynamic = like.frictionStatic;
	interaction->phys    = BondedPhys::contact(like, *bonded, nullptr, BondedPhys::reachOf(*interaction));
}

void Ip2_BondedMat_BondedMat_BondedPhys::bond(const std::vector<Vector2i>& pairs, const boost::python::object& factors)
{
	Scene& current = *Omega::instance().getScene();
	requireSingleProcess(current);
	checkMaterialsBetween(current);
	const std::vector<Real> factor = checkedFactors(factors, pairs.size());
	std::set<std::pair<int, int>> seen;
	Strengths                     strengths(current);
	std::vector<Planned>          planned; // all checks come first, so that nothing is half-built on error
	for (size_t i = 0; i < pairs.size(); i++) {
		const Vector2i& pair = pairs[i];
		if (pair[0] == pair[1]) refuse(pair, "a body cannot be bonded to itself");
		const auto [first, second] = std::minmax(pair[0], pair[1]);
		const Particle a = checkedParticle(current, pair, first), b = checkedParticle(current, pair, second);
		Vector3r       branch = b.body->state->pos - a.body->state->pos;
		const Vector3i period = nearestPeriod(current, branch);
		if (current.isPeriodic) branch += current.cell->intrShiftPos(period);
		const Real length = branch.norm();
		if (!(length > 0)) refuse(pair, "they have the same centre");
		if (current.isPeriodic) requireRoom(current, pair, length);
		const shared_ptr<Interaction> old = current.interactions->find(first, second);
		if (!seen.insert({ first, second }).second || isBonded(old)) refuse(pair, "they are bonded already");
		try {
			auto phys = BondedPhys::contact(
			        *a.material, *b.material, materialBetween(current, *a.material, *b.material),
			        a.sphere->radius + b.sphere->radius);
			const ddem::BondMaking making {
				phys->elasticity(), length, a.sphere->radius, b.sphere->radius
			};
			planned.push_back({ a, b, phys, strengths.of(*a.material, *b.material), making,
			                    factor.empty() ? 1 : factor[i], period, branch });
		} catch (const std::invalid_argument& error) {
			refuse(pair, error.what());
		}
	}
	for (const Planned& plan : planned) {
		const auto first = plan.a.body->getId(), second = plan.b.body->getId();
		if (const auto old = current.interactions->find(first, second))
			current.interactions->erase(first, second, old->linIx);
		auto interaction  = boost::make_shared<Interaction>(first, second);
		interaction->cellDist = plan.period;
		interaction->geom     = makeGeometry(plan.a, plan.b, current, interaction, plan.branch);
		interaction->phys = plan.phys;
		plan.phys->join(
		        *plan.criterion, plan.strength, plan.radius, *plan.a.body->state, *plan.b.body->state,
		        plan.branch);
		interaction->iterMadeReal = current.iter;
		current.interactions->insert(interaction);
	}
}

} // namespace yade
