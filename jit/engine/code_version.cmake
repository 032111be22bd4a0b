# Writes OUT: a hash of FILES and of COMPILED_WITH (compiler, flags, libraries), so that code on disk that another version
# has made is never taken for its own.
set(hashes "${COMPILED_WITH};")
foreach(file ${FILES})
    file(SHA256 ${file} hash)
    string(APPEND hashes ${hash})
endforeach()
string(SHA256 version "${hashes}")
file(WRITE ${OUT} "namespace haptel::jit {\nextern const char code_version[];\nconst char code_version[] = \"${version}\";\n}\n")
