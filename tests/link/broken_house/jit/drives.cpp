#include "codegen.h"
#include "runtime/servo_thread.h"
#include <llvm/IR/IRBuilder.h>
