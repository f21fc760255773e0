# GPL v2 or later, see LICENSE.
# Finds an installed YADE and the matching headers, and turns the binary's own feature list into compile definitions.
#
# Input    YADE_EXECUTABLE  the yade program (searched in PATH when unset)
#          YADE_SOURCE_DIR  YADE's source tree, or its source archive (unpacked into the build directory), of the same
#                           version
# Output   Yade_VERSION, YADE_FEATURES, YADE_LIBRARY_DIR, YADE_PREFIX_DIR, YADE_LIBRARY_SUBDIR (relative to the prefix),
#          and the target Yade::Yade with definitions, headers (as system headers:
#          their warnings are not ours) and libraries.
#
# YADE's classes change size and layout with its features, so a wrong definition would corrupt memory at run time
# without any link error. Nothing here is guessed: an unknown feature stops the configuration. The built plugin compares
# layouts once more when it is loaded (pkg/ddem/loader).

include(FindPackageHandleStandardArgs)

# ---- the binary ------------------------------------------------------------------------------------------------------
find_program(YADE_EXECUTABLE NAMES yade yade-double DOC "The yade program to build the plugin for")
if(NOT YADE_EXECUTABLE)
	message(FATAL_ERROR "No yade program found.\n"
		"Install it (Debian 13: apt-get install yade), point -DYADE_EXECUTABLE= to it, "
		"or let 'scripts/ddem setup' make an environment that has it.")
endif()

file(SHA256 "${YADE_EXECUTABLE}" yade_stamp)
if(NOT YADE_PROBE_STAMP STREQUAL "${YADE_EXECUTABLE};${yade_stamp}")
	# YADE_PREFIX would send the program to an overlay, perhaps with an older build of this very plugin inside.
	execute_process(
		COMMAND ${CMAKE_COMMAND} -E env --unset=YADE_PREFIX --unset=DISPLAY
			"${YADE_EXECUTABLE}" -n -x "${CMAKE_CURRENT_LIST_DIR}/yade_probe.py"
		OUTPUT_VARIABLE yade_output ERROR_VARIABLE yade_error RESULT_VARIABLE yade_result)
	string(REGEX MATCHALL "DDEM_PROBE [^\n]*" yade_facts "${yade_output}")
	if(NOT yade_result EQUAL 0 OR NOT yade_facts)
		message(FATAL_ERROR
			"${YADE_EXECUTABLE} does not run (exit code ${yade_result}):\n${yade_output}\n${yade_error}\n"
			"Does 'yade -n -x some_script.py' work? Otherwise give another one with -DYADE_EXECUTABLE=.")
	endif()
	foreach(key IN ITEMS version features libdir prefix real_bits real_digits mpmath python)
		string(REGEX MATCH "DDEM_PROBE ${key}=([^\n]*)" unused "${yade_output}")
		set(YADE_PROBE_${key} "${CMAKE_MATCH_1}" CACHE INTERNAL "YADE's own ${key}")
	endforeach()
	set(YADE_PROBE_STAMP "${YADE_EXECUTABLE};${yade_stamp}" CACHE INTERNAL "The program the facts above came from")
endif()
set(Yade_VERSION "${YADE_PROBE_version}")
set(YADE_LIBRARY_DIR "${YADE_PROBE_libdir}")
set(YADE_PREFIX_DIR "${YADE_PROBE_prefix}")
file(RELATIVE_PATH YADE_LIBRARY_SUBDIR "${YADE_PREFIX_DIR}" "${YADE_LIBRARY_DIR}")
set(YADE_FEATURES ${YADE_PROBE_features})

if(Yade_FIND_VERSION AND Yade_VERSION VERSION_LESS Yade_FIND_VERSION)
	message(FATAL_ERROR
		"${YADE_EXECUTABLE} is YADE ${Yade_VERSION}; this plugin needs ${Yade_FIND_VERSION} or later.\n"
		"Give a newer one with -DYADE_EXECUTABLE=, "
		"or let 'scripts/ddem setup' make an environment that has it.")
endif()
if(NOT YADE_PROBE_real_bits EQUAL 64)
	message(FATAL_ERROR
		"${YADE_EXECUTABLE} calculates with ${YADE_PROBE_real_bits}-bit numbers; "
		"this plugin's kernel is double precision.\n"
		"Use the double build: -DYADE_EXECUTABLE=/usr/bin/yade-double.")
endif()

# ---- features -> definitions -----------------------------------------------------------------------------------------
# One line a feature, as in the ADD_DEFINITIONS of YADE's own CMakeLists.txt; "-" for features without a definition.
set(yade_definitions_LOGGER YADE_BOOST_LOG BOOST_LOG_DYN_LINK)
set(yade_definitions_USEFUL_ERRORS -)
set(yade_definitions_FAST_NATIVE -)
set(yade_definitions_COMPLEX_MP YADE_COMPLEX_MP)
set(yade_definitions_MPFR YADE_MPFR)
set(yade_definitions_MPC -)
set(yade_definitions_VECTORIZE -)
set(yade_definitions_VTK YADE_VTK)
set(yade_definitions_OPENMP YADE_OPENMP)
set(yade_definitions_GTS YADE_GTS)
set(yade_definitions_QT5 YADE_OPENGL YADE_QT5 QT_NO_KEYWORDS)
set(yade_definitions_CGAL YADE_CGAL CGAL_DISABLE_ROUNDING_MATH_CHECK)
set(yade_definitions_PFVFLOW FLOW_ENGINE)
set(yade_definitions_LINSOLV LINSOLV)
set(yade_definitions_CHOLMOD_GPU PFV_GPU)
set(yade_definitions_MPI YADE_MPI)
set(yade_definitions_TWOPHASEFLOW TWOPHASEFLOW)
set(yade_definitions_SPH YADE_SPH)
set(yade_definitions_LS_DEM YADE_LS_DEM)
set(yade_definitions_DEFORM YADE_DEFORM)
set(yade_definitions_FEMLIKE YADE_FEM)
set(yade_definitions_LIQMIGRATION YADE_LIQMIGRATION)
set(yade_definitions_GL2PS YADE_GL2PS)
set(yade_definitions_LBMFLOW LBM_ENGINE)
set(yade_definitions_THERMAL THERMAL)
set(yade_definitions_PARTIALSAT PARTIALSAT)
set(yade_definitions_PROFILING USE_TIMING_DELTAS ISC_TIMING)
set(yade_definitions_POTENTIAL_PARTICLES YADE_POTENTIAL_PARTICLES)
set(yade_definitions_POTENTIAL_BLOCKS YADE_POTENTIAL_BLOCKS)

set(YADE_EXTRA_DEFINITIONS "" CACHE STRING
	"Definitions of a YADE built with options this file does not know (semicolons between)")
set(YADE_EXTRA_FEATURES "" CACHE STRING "Names of features covered by YADE_EXTRA_DEFINITIONS")

set(yade_definitions MAX_LOG_LEVEL=5 YADE_ODEINT YADE_REAL_BIT=${YADE_PROBE_real_bits}
	YADE_REAL_DEC=${YADE_PROBE_real_digits} ${YADE_EXTRA_DEFINITIONS})
foreach(feature IN LISTS YADE_FEATURES)
	if(DEFINED yade_definitions_${feature})
		if(NOT yade_definitions_${feature} STREQUAL "-")
			list(APPEND yade_definitions ${yade_definitions_${feature}})
		endif()
	elseif(NOT feature IN_LIST YADE_EXTRA_FEATURES)
		message(FATAL_ERROR
			"${YADE_EXECUTABLE} was built with the feature ${feature}, which may change the layout of its "
			"classes in a way this build does not know.\n"
			"Look up its definitions in YADE's CMakeLists.txt and add "
			"-DYADE_EXTRA_FEATURES=${feature} -DYADE_EXTRA_DEFINITIONS='YADE_…;…'.\n"
			"(MASK_ARBITRARY needs YADE_MASK_ARBITRARY;YADE_MASK_ARBITRARY_SIZE=256 "
			"or the size chosen there.)")
	endif()
endforeach()
foreach(feature IN ITEMS OPENMP)
	if(NOT feature IN_LIST YADE_FEATURES)
		message(FATAL_ERROR
			"${YADE_EXECUTABLE} lacks the feature ${feature}, which the deformable engine needs "
			"(it has: ${YADE_FEATURES}).\n"
			"Use a YADE built with -DENABLE_${feature}=ON, as Debian's is: -DYADE_EXECUTABLE=.")
	endif()
endforeach()
if(NOT "VECTORIZE" IN_LIST YADE_FEATURES)
	list(APPEND yade_definitions EIGEN_DONT_VECTORIZE EIGEN_DONT_ALIGN EIGEN_DISABLE_UNALIGNED_ARRAY_ASSERT)
endif()
if(NOT YADE_PROBE_mpmath)
	list(APPEND yade_definitions YADE_DISABLE_REAL_MULTI_HP)
endif()
if(NOT CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|amd64|i.86" OR CMAKE_CXX_COMPILER_ID MATCHES "Clang")
	list(APPEND yade_definitions YADE_FLOAT128_UNAVAILABLE)
endif()
set(YADE_DEFINITIONS ${yade_definitions})

# ---- the headers of the same version ---------------------------------------------------------------------------------
set(YADE_SOURCE_DIR "" CACHE PATH
	"Source tree (or source archive) of the same YADE version; Debian packages no headers")
set(YADE_INCLUDE_DIR "${YADE_SOURCE_DIR}")
if(YADE_SOURCE_DIR AND EXISTS "${YADE_SOURCE_DIR}" AND NOT IS_DIRECTORY "${YADE_SOURCE_DIR}")
	file(SHA256 "${YADE_SOURCE_DIR}" archive_hash)
	string(SUBSTRING "${archive_hash}" 0 12 archive_hash)
	set(unpacked "${CMAKE_BINARY_DIR}/yade-source-${archive_hash}")
	if(NOT EXISTS "${unpacked}")
		message(STATUS "Unpacking YADE's headers from ${YADE_SOURCE_DIR}")
		file(ARCHIVE_EXTRACT INPUT "${YADE_SOURCE_DIR}" DESTINATION "${unpacked}.partial"
			PATTERNS "*/RELEASE" "*.hpp" "*.h" "*.ipp")
		file(RENAME "${unpacked}.partial" "${unpacked}")
	endif()
	file(GLOB YADE_INCLUDE_DIR LIST_DIRECTORIES true "${unpacked}/*")
endif()
if(NOT EXISTS "${YADE_INCLUDE_DIR}/core/Scene.hpp")
	message(FATAL_ERROR "No YADE headers: ${YADE_SOURCE_DIR} holds no core/Scene.hpp (-DYADE_SOURCE_DIR=).\n"
		"Debian packages none, but its source archive has them, in exactly the binary's version: "
		"apt-get source --tar-only yade (needs a deb-src line), "
		"then -DYADE_SOURCE_DIR=yade_${Yade_VERSION}.orig.tar.bz2; "
		"or use 'scripts/ddem setup', which does it for you.")
endif()
file(STRINGS "${YADE_INCLUDE_DIR}/RELEASE" yade_source_version LIMIT_COUNT 1)
if(NOT yade_source_version STREQUAL Yade_VERSION)
	message(FATAL_ERROR
		"The headers in ${YADE_INCLUDE_DIR} are of YADE ${yade_source_version}, "
		"but ${YADE_EXECUTABLE} is ${Yade_VERSION}.\n"
		"They must be the same, else the plugin would corrupt memory: "
		"give the ${Yade_VERSION} tree with -DYADE_SOURCE_DIR=.")
endif()

# ---- what the headers include ----------------------------------------------------------------------------------------
find_package(Python3 ${YADE_PROBE_python} EXACT REQUIRED COMPONENTS Interpreter Development.Module NumPy)
set(yade_python_component "python${Python3_VERSION_MAJOR}${Python3_VERSION_MINOR}")
find_package(Boost 1.74 REQUIRED COMPONENTS ${yade_python_component} serialization iostreams thread filesystem regex)
find_package(Eigen3 3.3 REQUIRED NO_MODULE)
find_package(OpenMP REQUIRED COMPONENTS CXX)
set(yade_libraries Boost::${yade_python_component} Boost::serialization Boost::iostreams Boost::thread
	Boost::filesystem Boost::regex Eigen3::Eigen OpenMP::OpenMP_CXX)
if("LOGGER" IN_LIST YADE_FEATURES)
	find_package(Boost 1.74 REQUIRED COMPONENTS log log_setup)
	list(APPEND yade_libraries Boost::log Boost::log_setup)
endif()
if("MPI" IN_LIST YADE_FEATURES)
	find_package(MPI REQUIRED COMPONENTS CXX)
	list(APPEND yade_libraries MPI::MPI_CXX)
endif()
if("CGAL" IN_LIST YADE_FEATURES)
	find_package(CGAL REQUIRED)
	list(APPEND yade_libraries CGAL::CGAL)
endif()

foreach(name IN ITEMS yade pkg_common pkg_dem)
	find_library(YADE_LIBRARY_${name} NAMES ${name} PATHS "${YADE_LIBRARY_DIR}" NO_DEFAULT_PATH REQUIRED)
	mark_as_advanced(YADE_LIBRARY_${name})
	list(APPEND yade_libraries "${YADE_LIBRARY_${name}}")
endforeach()

find_package_handle_standard_args(Yade
	REQUIRED_VARS YADE_EXECUTABLE YADE_LIBRARY_DIR YADE_INCLUDE_DIR VERSION_VAR Yade_VERSION)

if(NOT TARGET Yade::Yade)
	add_library(Yade::Yade INTERFACE IMPORTED)
	set_target_properties(Yade::Yade PROPERTIES
		INTERFACE_COMPILE_DEFINITIONS "${YADE_DEFINITIONS}"
		# without it the compiler needs gigabytes for YADE's attribute macros
		INTERFACE_COMPILE_OPTIONS "-ftrack-macro-expansion=0"
		INTERFACE_COMPILE_FEATURES cxx_std_17
		INTERFACE_INCLUDE_DIRECTORIES "${YADE_INCLUDE_DIR}" # imported, hence -isystem
		INTERFACE_LINK_LIBRARIES "Python3::Module;Python3::NumPy;${yade_libraries}")
endif()
