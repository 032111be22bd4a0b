#include "codegen.h"
#include "runtime/servo/servo_thread.h"
#include <llvm/IR/IRBuilder.h>
