// GPL v2 or later, see LICENSE.
// YADE attributes made from a list of parameters, see kernel/algebra/Parameters.hpp.
#pragma once

#include <pkg/ddem/kernel/algebra/Parameters.hpp>

// A parameter is called as its member.
#define DDEM_ATTRIBUTE(name, standard, unit, bounds, wayOut, doc) \
	((Real, name, standard, Attr::triggerPostLoad, "[" unit "] " doc))
#define DDEM_COPY_PARAMETER(name, standard, unit, bounds, wayOut, doc) p.name = name;
