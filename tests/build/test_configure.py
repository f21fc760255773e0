# GPL v2 or later, see LICENSE.
# A YADE or headers that do not fit stop the configuration with the cause and the way out.
import pathlib
import subprocess

import pytest

FIND_YADE = pathlib.Path(__file__).resolve().parents[2] / 'scripts' / 'cmake' / 'FindYade.cmake'
DEBIANS_YADE = {
	'version': '2025.2.0', 'features': 'LOGGER;OPENMP;QT5', 'libdir': '/usr/lib/yade', 'prefix': '/usr',
	'real_bits': '64', 'real_digits': '15', 'mpmath': '1', 'python': '3.13'
}


def find_yade(folder, **variables):
	driver = folder / 'driver.cmake'
	driver.write_text('cmake_minimum_required(VERSION 3.25)\ninclude("%s")\n' % FIND_YADE)
	result = subprocess.run(
		['cmake', *('-D%s=%s' % variable for variable in variables.items()), '-P', driver],
		cwd=folder,
		capture_output=True,
		text=True,
	)
	assert result.returncode != 0
	return ' '.join(result.stderr.split())


@pytest.fixture
def configure(tmp_path):
	"""Runs the search with a program that answers as a YADE with the given facts would;
	gives CMake's error message as one line."""

	def run(source_version='2025.2.0', **facts):
		program = tmp_path / 'yade'
		answers = ''.join('echo "DDEM_PROBE %s=%s"\n' % fact for fact in {**DEBIANS_YADE, **facts}.items())
		program.write_text('#!/bin/sh\n' + answers)
		program.chmod(0o755)
		source = tmp_path / 'source'
		if source_version:
			(source / 'core').mkdir(parents=True)
			(source / 'core' / 'Scene.hpp').touch()
			(source / 'RELEASE').write_text(source_version + '\n')
		return find_yade(tmp_path, Yade_FIND_VERSION='2025.2', YADE_EXECUTABLE=program, YADE_SOURCE_DIR=source)

	return run


def test_older_yade(configure):
	error = configure(version='2023.02')
	assert 'is YADE 2023.02; this plugin needs 2025.2 or later' in error and "'scripts/ddem setup'" in error


def test_yade_of_another_precision(configure):
	error = configure(real_bits='128', real_digits='33')
	assert 'calculates with 128-bit numbers' in error and '-DYADE_EXECUTABLE=/usr/bin/yade-double' in error


def test_feature_whose_definitions_are_not_known(configure):
	error = configure(features='OPENMP;WARP_DRIVE')
	assert 'was built with the feature WARP_DRIVE' in error and '-DYADE_EXTRA_FEATURES=WARP_DRIVE' in error


def test_missing_feature(configure):
	error = configure(features='LOGGER;QT5')
	assert 'lacks the feature OPENMP' in error and '-DENABLE_OPENMP=ON' in error


def test_headers_of_another_version(configure):
	error = configure(source_version='2025.1.0')
	assert 'are of YADE 2025.1.0, but' in error and 'give the 2025.2.0 tree with -DYADE_SOURCE_DIR=' in error


def test_no_headers(configure):
	error = configure(source_version=None)
	assert (
		'No YADE headers' in error
		and 'apt-get source --tar-only yade' in error
		and 'yade_2025.2.0.orig.tar.bz2' in error
	)


def test_program_that_does_not_run(tmp_path):
	program = tmp_path / 'yade'
	program.write_text('#!/bin/sh\necho broken >&2\nexit 3\n')
	program.chmod(0o755)
	error = find_yade(tmp_path, YADE_EXECUTABLE=program)
	assert 'does not run (exit code 3)' in error and 'broken' in error
