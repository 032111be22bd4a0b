// The linker is the test: see CMakeLists.txt.
int main() {}
