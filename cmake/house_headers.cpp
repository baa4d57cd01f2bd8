// Nothing: what is wanted are the headers (house_headers.hpp), parsed.
