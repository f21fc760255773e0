// GPL v2 or later, see LICENSE.
// Compares the memory layout of YADE's classes, as this plugin was compiled, with the YADE that is running.
#include <pkg/ddem/loader/LayoutCheck.hpp>

#include <pkg/ddem/YadeInclude.hpp>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <malloc.h>
#include <memory>
#include <vector>

namespace yade::ddem {

namespace {

	std::unique_ptr<Factorable> makeStockObject(const char* name)
	{
		return std::unique_ptr<Factorable>(ClassFactory::instance().createPure(name));
	}

	std::size_t usableSize(const Factorable& object)
	{
		return malloc_usable_size(const_cast<void*>(dynamic_cast<const void*>(&object)));
	}

	struct Block {
		explicit Block(std::size_t size)
		        : start(std::malloc(size))
		{
		}
		~Block() { std::free(start); }
		Block(const Block&) = delete;
		Block& operator=(const Block&) = delete;
		void*  start;
	};
	std::size_t usableSize(const Block& block) { return malloc_usable_size(block.start); }

	/// The smallest block that the allocator handed out for any of several objects alive at once. Sizes of two
	/// classes are comparable only as the allocator rounds them, and it now and then gives the rest of a free chunk
	/// away with one that is too small to keep: 16 bytes more, by chance of the heap.
	template <typename Make> std::size_t smallestUsableSize(int objects, Make make)
	{
		std::vector<decltype(make())> alive;
		std::size_t                   smallest = std::numeric_limits<std::size_t>::max();
		for (int i = 0; i < objects; i++) {
			alive.push_back(make());
			smallest = std::min(smallest, usableSize(*alive.back()));
		}
		return smallest;
	}

	/// Compares the size of class `Class`, called `name` in YADE's factory.
	template <typename Class> std::string compareSize(const char* name)
	{
		std::size_t inYade = 0, here = 0;
		for (const int objects : { 4, 16 }) { // the usual case needs no second look
			inYade = smallestUsableSize(objects, [name] { return makeStockObject(name); });
			here   = smallestUsableSize(objects, [] { return std::make_unique<Block>(sizeof(Class)); });
			if (inYade == here) return "";
		}
		return std::string("  class ") + name + ": " + std::to_string(inYade) + " bytes in YADE, "
		        + std::to_string(here) + " in the plugin\n";
	}

	template <typename Class> std::string compare(const char* name)
	{
		return compareSize<Class>(name);
	}

	/// Compares the size, then the place of a member, which must be a number or a truth value: Python knows
	/// no other types yet when plugins are loaded.
	template <typename Class, typename Member, typename Owner>
	std::string compare(const char* name, const char* attribute, Member Owner::*member, Member value)
	{
		const std::string sizes = compareSize<Class>(name);
		if (!sizes.empty()) return sizes; // reading a member could then reach beyond the object
		const std::unique_ptr<Factorable> stock  = makeStockObject(name);
		Class&                            object = static_cast<Class&>(*stock);
		object.pySetAttr(attribute, boost::python::object(value));
		if (object.*member == value) return "";
		return std::string("  class ") + name + ": its member " + attribute
		        + " lies elsewhere in YADE than in the plugin\n";
	}

} // namespace

std::string layoutDifferences()
{
	// Values differ from the members' defaults, so that a member at the wrong place cannot hold them by accident.
	// clang-format off
	return compare<Shape>("Shape", "highlight", &Shape::highlight, true)
	        + compare<Sphere>("Sphere", "radius", &Sphere::radius, Real(0.3125))
	        + compare<State>("State", "densityScaling", &State::densityScaling, Real(0.3125))
	        // one more number in State may hide in what the allocator rounds up, not from what derives from it
	        + compare<ThermalState>("ThermalState", "temp", &ThermalState::temp, Real(0.3125))
	        + compare<Body>("Body", "timeBorn", &Body::timeBorn, Real(0.3125))
	        + compare<Bound>("Bound", "lastUpdateIter", &Bound::lastUpdateIter, 31)
	        + compare<Aabb>("Aabb")
	        + compare<Material>("Material", "density", &Material::density, Real(0.3125))
	        + compare<FrictMat>("FrictMat", "frictionAngle", &FrictMat::frictionAngle, Real(0.3125))
	        + compare<Interaction>("Interaction", "iterBorn", &Interaction::iterBorn, 31L)
	        + compare<ScGeom6D>("ScGeom6D", "twist", &ScGeom6D::twist, Real(0.3125))
	        + compare<FrictPhys>("FrictPhys", "tangensOfFrictionAngle", &FrictPhys::tangensOfFrictionAngle,
	                Real(0.3125))
	        + compare<GlobalEngine>("GlobalEngine", "dead", &GlobalEngine::dead, true)
	        + compare<PartialEngine>("PartialEngine")
	        + compare<PeriodicEngine>("PeriodicEngine", "nDone", &PeriodicEngine::nDone, 31L)
	        + compare<IPhysFunctor>("IPhysFunctor")
	        + compare<LawFunctor>("LawFunctor")
	        + compare<BoundFunctor>("BoundFunctor")
	        + compare<NewtonIntegrator>("NewtonIntegrator", "mask", &NewtonIntegrator::mask, 31)
	        + compare<BodyContainer>("BodyContainer", "enableRedirection", &BodyContainer::enableRedirection, false)
	        + compare<InteractionContainer>("InteractionContainer")
	        + compare<EnergyTracker>("EnergyTracker")
	        + compare<Cell>("Cell")
	        + compare<Scene>("Scene", "selectedBody", &Scene::selectedBody, 31);
	// clang-format on
}

} // namespace yade::ddem
