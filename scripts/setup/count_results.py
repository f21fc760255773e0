# GPL v2 or later, see LICENSE.
# Adds up JUnit reports: count_results.py GROUP=FILE…  Prints one closing line; fails when a test has failed or a group
# has left no report (its program crashed).
import sys
import xml.etree.ElementTree as ElementTree

passed = failed = skipped = 0
for argument in sys.argv[1:]:
	group, _, path = argument.partition('=')
	try:
		cases = list(ElementTree.parse(path).iter('testcase'))
	except (OSError, ElementTree.ParseError) as error:
		print('%s: no report, its program has crashed (%s)' % (group, error), file=sys.stderr)
		failed += 1
		continue
	bad = [case for case in cases if case.find('failure') is not None or case.find('error') is not None]
	idle = [case for case in cases if case.find('skipped') is not None or case.get('status') == 'notrun']
	failed += len(bad)
	skipped += len(idle)
	passed += len(cases) - len(bad) - len(idle)
print('%d passed, %d failed' % (passed, failed) + (', %d skipped' % skipped if skipped else ''))
sys.exit(1 if failed or not passed else 0)
