# GPL v2 or later, see LICENSE.
# The plugin is loaded by stock YADE from where it was installed.
import os

import yade
import yade.config


def test_plugin_library_is_loaded_from_its_prefix():
	library = os.path.join(yade.config.libDir, 'libpkg_ddem.so')
	assert os.path.exists(library)
	with open('/proc/self/maps') as maps:
		assert any(os.path.realpath(library) == line.split()[-1] for line in maps)


def test_package_is_found_beside_the_library():
	assert os.path.join(yade.config.libDir, 'py', 'yade') in yade.__path__
