# Writes OUT: a hash of FILES, so that code on disk that another version has made is never taken for its own.
set(hashes "")
foreach(file ${FILES})
    file(SHA256 ${file} hash)
    string(APPEND hashes ${hash})
endforeach()
string(SHA256 version "${hashes}")
file(WRITE ${OUT} "#include \"jit/engine/code_version.h\"\nconst char haptel::jit::code_version[] = \"${version}\";\n")
