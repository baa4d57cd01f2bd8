// Empty: compiled only to precompile house_headers.hpp.
