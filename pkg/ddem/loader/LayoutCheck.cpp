// GPL v2 or later, see LICENSE.
// Compares what this plugin was compiled for with the YADE that is running.
#include <pkg/ddem/loader/LayoutCheck.hpp>

#include <lib/factory/ClassFactory.hpp>
#undef REGISTER_FACTORABLE
#define REGISTER_FACTORABLE(name) // the stock classes are registered already; see pkg/ddem/YadeInclude.hpp
#include <core/Body.hpp>
#include <core/Scene.hpp>
#include <core/Shape.hpp>
#include <core/State.hpp>
#include <pkg/dem/NewtonIntegrator.hpp>
#include <pkg/dem/ScGeom.hpp>
#include <malloc.h>
#include <memory>

namespace yade::ddem {

namespace {

	/// What the allocator really hands out for `size` bytes: the sizes of two classes can only be compared after this rounding.
	std::size_t usableSize(std::size_t size)
	{
		std::unique_ptr<void, decltype(&std::free)> block(std::malloc(size), &std::free);
		return malloc_usable_size(block.get());
	}

	template <typename Class, typename Member> std::string compare(const char* name, const char* attribute, Member Class::*member, Member value)
	{
		const std::string                     prefix = std::string("  ") + name + ": ";
		const std::unique_ptr<Factorable>     object(ClassFactory::instance().createPure(name));
		const std::size_t                     theirs = malloc_usable_size(dynamic_cast<void*>(object.get())), ours = usableSize(sizeof(Class));
		if (theirs != ours) return prefix + std::to_string(theirs) + " bytes in YADE, " + std::to_string(ours) + " in the plugin\n";
		Class& typed = static_cast<Class&>(*object);
		typed.pySetAttr(attribute, boost::python::object(value));
		if (!(typed.*member == value)) return prefix + "its member " + attribute + " lies elsewhere\n";
		return "";
	}

} // namespace

std::string layoutDifferences()
{
	return compare("Shape", "highlight", &Shape::highlight, true) + compare("State", "densityScaling", &State::densityScaling, Real(0.125));
}

} // namespace yade::ddem
