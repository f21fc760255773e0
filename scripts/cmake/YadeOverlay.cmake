# GPL v2 or later, see LICENSE.
# At install time, makes DDEM_OVERLAY a YADE prefix of symbolic links to the installed YADE, so that the plugin can be
# added to it without rights on YADE's own directories.  YADE looks there when YADE_PREFIX names it.
file(TO_CMAKE_PATH "${DDEM_OVERLAY}" overlay)
install(CODE "
	set(stock \"${YADE_LIBRARY_DIR}\")
	set(mine \"${overlay}/${YADE_LIBRARY_SUBDIR}\")
	foreach(folder IN ITEMS \"\" /py /py/yade)
		file(MAKE_DIRECTORY \"\${mine}\${folder}\")
		file(GLOB entries RELATIVE \"\${stock}\${folder}\" \"\${stock}\${folder}/*\")
		list(REMOVE_ITEM entries py yade ddem __pycache__ libpkg_ddem.so ddem_classes.so)
		foreach(entry IN LISTS entries)
			file(CREATE_LINK \"\${stock}\${folder}/\${entry}\" \"\${mine}\${folder}/\${entry}\" SYMBOLIC)
		endforeach()
	endforeach()
	# yade-batch starts the program in bin of its prefix, which is named like the directory of its libraries.
	get_filename_component(program \"\${stock}\" NAME)
	file(GLOB programs RELATIVE \"${YADE_PREFIX_DIR}/bin\" \"${YADE_PREFIX_DIR}/bin/\${program}*\")
	file(MAKE_DIRECTORY \"${overlay}/bin\")
	foreach(program IN LISTS programs)
		file(CREATE_LINK \"${YADE_PREFIX_DIR}/bin/\${program}\" \"${overlay}/bin/\${program}\" SYMBOLIC)
	endforeach()
	file(CREATE_LINK \"${YADE_LIBRARY_SUBDIR}/py\" \"${overlay}/python\" SYMBOLIC) # for PYTHONPATH
	message(STATUS \"Overlay prefix of links to \${stock}: ${overlay}\")
" COMPONENT classes)

# Modules that the checkout no longer has must not be found any more, nor folders,
# which Python would take for empty packages.
install(CODE "
	set(package \"${overlay}/${YADE_LIBRARY_SUBDIR}/py/yade/ddem\")
	file(GLOB_RECURSE entries LIST_DIRECTORIES true RELATIVE \"\${package}\" \"\${package}/*\")
	list(FILTER entries EXCLUDE REGEX \"[.]so$\")
	foreach(entry IN LISTS entries)
		if(NOT EXISTS \"${PROJECT_SOURCE_DIR}/py/ddem/\${entry}\")
			file(REMOVE_RECURSE \"\${package}/\${entry}\")
		endif()
	endforeach()
" COMPONENT python)
