// GPL v2 or later, see LICENSE.
// YADE's headers for the plugin's classes, in a form that is cheap to compile.
// Include it first in every file that declares YADE classes.
//
// Every YADE header registers its class with the factory through REGISTER_FACTORABLE, which makes each of our files
// re-emit the factories, and with them the Python registration and serialization, of every stock class it includes:
// some 20 of 36 seconds.  The stock libraries have registered their classes already, so the macro is empty here;
// our own are registered by DDEM_PLUGIN, once, in the file that implements them,
// and not in every file that reads their header.
#pragma once

#include <lib/factory/ClassFactory.hpp>
#undef REGISTER_FACTORABLE
#define REGISTER_FACTORABLE(name)

#include <lib/base/Math.hpp>
#include <lib/serialization/Serializable.hpp>
#include <core/Aabb.hpp>
#include <core/Body.hpp>
#include <core/Callbacks.hpp>
#include <core/Dispatching.hpp>
#include <core/GlobalEngine.hpp>
#include <core/IGeom.hpp>
#include <core/IPhys.hpp>
#include <core/InteractionLoop.hpp>
#include <core/Material.hpp>
#include <core/Omega.hpp>
#include <core/PartialEngine.hpp>
#include <core/Scene.hpp>
#include <core/Shape.hpp>
#include <core/State.hpp>
#include <pkg/common/ElastMat.hpp>
#include <pkg/common/Facet.hpp>
#include <pkg/common/KinematicEngines.hpp>
#include <pkg/common/NormShearPhys.hpp>
#include <pkg/common/PeriodicEngines.hpp>
#include <pkg/common/Sphere.hpp>
#include <pkg/common/Wall.hpp>
#include <pkg/dem/FrictPhys.hpp>
#include <pkg/dem/NewtonIntegrator.hpp>
#include <pkg/dem/ScGeom.hpp>
#ifdef YADE_OPENGL
#include <pkg/common/GLDrawFunctors.hpp>
#endif

namespace yade {

template <class Class> bool registerClass(const char* name)
{
	return ClassFactory::instance().registerFactorable(
	        name, []() -> Factorable* { return new Class; },
	        []() -> shared_ptr<Factorable> { return shared_ptr<Class>(new Class); },
	        []() -> void* { return new Class; });
}

} // namespace yade

#define DDEM_REGISTER_CLASS(x, y, name) \
	const bool BOOST_PP_CAT(registered, name) __attribute__((unused)) \
	        = registerClass<name>(BOOST_PP_STRINGIZE(name));
/// YADE_PLUGIN for our classes: also registers them with the factory.
#define DDEM_PLUGIN(classes) YADE_PLUGIN(classes) BOOST_PP_SEQ_FOR_EACH(DDEM_REGISTER_CLASS, ~, classes)
