#include "jit/codegen_module.h"

#include "jit/codegen_function.h"

#include <algorithm>

namespace haptel::jit {

namespace {

bool any(const std::vector<bool>& flags)
{
    return std::find(flags.begin(), flags.end(), true) != flags.end();
}

} // namespace

llvm::Type* ModuleEmitter::type(ir::Type type, bool in_lanes)
{
    llvm::LLVMContext& context = target.getContext();
    const auto form = [&](llvm::Type* scalar) -> llvm::Type* {
        return in_lanes ? llvm::FixedVectorType::get(scalar, lanes) : scalar;
    };
    switch (type) {
    case ir::Type::real: return form(llvm::Type::getDoubleTy(context));
    case ir::Type::i32:
    case ir::Type::u32: return form(llvm::Type::getInt32Ty(context));
    case ir::Type::boolean: return form(llvm::Type::getInt1Ty(context));
    case ir::Type::image: return llvm::PointerType::getUnqual(context); // the same for every point
    }
    return nullptr;
}

llvm::GlobalVariable* ModuleEmitter::table(uint32_t index)
{
    if (tables[index]) return tables[index];
    const ir::Table& table = source.tables[index];
    llvm::LLVMContext& context = target.getContext();
    llvm::Constant* cells = table.element == ir::Type::real ? llvm::ConstantDataArray::get(context, table.reals)
                                                            : llvm::ConstantDataArray::get(context, table.words);
    tables[index] = new llvm::GlobalVariable(target, cells->getType(), true, llvm::GlobalValue::InternalLinkage, cells);
    tables[index]->setUnnamedAddr(llvm::GlobalValue::UnnamedAddr::Global);
    return tables[index];
}

llvm::Function* ModuleEmitter::function(uint32_t index, const std::vector<bool>& arguments)
{
    const auto [place, is_new] = functions.try_emplace({index, arguments}, nullptr);
    if (!is_new) return place->second;
    const ir::Function& from = source.functions[index];
    const bool in_lanes = any(arguments);
    std::vector<llvm::Type*> parameters, results;
    for (size_t i = 0; i < arguments.size(); ++i)
        parameters.push_back(type(from.type(from.parameters[i]), arguments[i]));
    for (ir::Value result : from.body.yields) results.push_back(type(from.type(result), in_lanes));
    llvm::Type* result = results.size() == 1 ? results[0] : llvm::StructType::get(target.getContext(), results);
    auto* function = llvm::Function::Create(llvm::FunctionType::get(result, parameters, false),
                                            llvm::GlobalValue::InternalLinkage, from.name, target);
    function->setCallingConv(llvm::CallingConv::Fast);
    function->setDoesNotThrow();
    const bool reads_images = std::any_of(from.parameters.begin(), from.parameters.end(),
                                          [&](ir::Value value) { return from.type(value) == ir::Type::image; });
    reads_images ? function->setOnlyReadsMemory() : function->setDoesNotAccessMemory();
    function->setWillReturn();
    place->second = function;
    unfinished.push_back(place);
    return function;
}

// A list, not a recursion: functions may call each other in long chains.
void ModuleEmitter::finish()
{
    while (!unfinished.empty()) {
        const auto next = unfinished.back();
        unfinished.pop_back();
        write_body(next->first, *next->second);
    }
}

void ModuleEmitter::write_body(const Form& form, llvm::Function& function)
{
    const ir::Function& from = source.functions[form.first];
    llvm::BasicBlock::Create(target.getContext(), "", &function);
    FunctionEmitter emitter(*this, from, function, form.second);
    for (size_t i = 0; i < from.parameters.size(); ++i)
        emitter.define(from.parameters[i], function.getArg(static_cast<unsigned>(i)));
    const std::vector<llvm::Value*> yields = emitter.body(any(form.second));
    if (yields.size() == 1)
        emitter.at_end().CreateRet(yields[0]);
    else
        emitter.at_end().CreateAggregateRet(yields.data(), static_cast<unsigned>(yields.size()));
}

} // namespace haptel::jit
