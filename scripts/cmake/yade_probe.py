# GPL v2 or later, see LICENSE.
# Run by FindYade.cmake inside the YADE it has found: says, one "key=value" a line, what that binary was built with.
import sys
from yade import config

print('DDEM_PROBE version=' + config.version)
print('DDEM_PROBE features=' + ';'.join(config.features))
print('DDEM_PROBE libdir=' + config.libDir)
print('DDEM_PROBE prefix=' + config.prefix)
print('DDEM_PROBE real_bits=%d' % config.highPrecisionBits)
print('DDEM_PROBE real_digits=%d' % config.highPrecisionDecimalPlaces)
print('DDEM_PROBE mpmath=%d' % bool(config.highPrecisionMpmath))
print('DDEM_PROBE python=%d.%d' % sys.version_info[:2])
