"""Prints the total mass [kg] that MuJoCo's library compiles from a model: masses.py LIBRARY FILE.

It runs as a separate process, because the library may end the process on an error.
"""
import ctypes
import sys

library = ctypes.CDLL(sys.argv[1])
library.mj_loadXML.restype = ctypes.c_void_p
library.mj_loadXML.argtypes = [ctypes.c_char_p, ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int]
library.mj_getTotalmass.restype = ctypes.c_double
library.mj_getTotalmass.argtypes = [ctypes.c_void_p]
error = ctypes.create_string_buffer(1000)
model = library.mj_loadXML(sys.argv[2].encode(), None, error, 1000)
if not model:
    sys.exit(error.value.decode("utf-8", "replace"))
print(repr(library.mj_getTotalmass(model)))
