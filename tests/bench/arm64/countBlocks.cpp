/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// A plugin of qemu-user 7.2: which blocks of code run how often from the entry of vpCountedFrames to its
// return, and what the caches and the branch prediction of a Cortex-A53 would have missed meanwhile.
// ../arm64.sh builds and reads it: qemu-aarch64 -plugin libcountBlocks.so,out=FILE PROGRAM

#include <array>
#include <cinttypes>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

// What is used of the plugins' interface, version 1, as QEMU documents it; Debian ships no header of it.
extern "C" {
struct qemu_plugin_tb;
struct qemu_plugin_insn;
enum { QEMU_PLUGIN_CB_NO_REGS = 0 };
enum { QEMU_PLUGIN_MEM_RW = 3 };
typedef void (*PluginTranslated)(uint64_t plugin, qemu_plugin_tb *block);
typedef void (*PluginExecuted)(unsigned int cpu, void *data);
typedef void (*PluginAccessed)(unsigned int cpu, uint32_t info, uint64_t address, void *data);
typedef void (*PluginExit)(uint64_t plugin, void *data);
void qemu_plugin_register_vcpu_tb_trans_cb(uint64_t plugin, PluginTranslated);
void qemu_plugin_register_vcpu_tb_exec_cb(qemu_plugin_tb *, PluginExecuted, int flags, void *data);
void qemu_plugin_register_vcpu_insn_exec_cb(qemu_plugin_insn *, PluginExecuted, int flags, void *data);
void qemu_plugin_register_vcpu_mem_cb(qemu_plugin_insn *, PluginAccessed, int flags, int access, void *data);
void qemu_plugin_register_atexit_cb(uint64_t plugin, PluginExit, void *data);
size_t qemu_plugin_tb_n_insns(const qemu_plugin_tb *);
qemu_plugin_insn *qemu_plugin_tb_get_insn(const qemu_plugin_tb *, size_t index);
const void *qemu_plugin_insn_data(const qemu_plugin_insn *);
uint64_t qemu_plugin_insn_vaddr(const qemu_plugin_insn *);
const char *qemu_plugin_insn_symbol(const qemu_plugin_insn *);
}

namespace
{
constexpr uint32_t returnInstruction = 0xd65f03c0;

struct Block {
  uint64_t address = 0;
  uint64_t executed = 0;
  std::vector<uint32_t> code;

  bool endsInCondition() const // b.cond, cbz, cbnz, tbz, tbnz
  {
    const uint32_t last = code.back();
    return (last & 0xff000010) == 0x54000000 || (last & 0x7c000000) == 0x34000000;
  }
  uint64_t end() const { return address + 4 * code.size(); }
};

//! Least recently used first out, by 64-byte lines; without the prefetching that the real one does.
template <size_t sets, size_t ways>
class Cache
{
public:
  //! \return Whether it had the line; now it has.
  bool has(uint64_t line)
  {
    std::array<uint64_t, ways> &set = m_lines[line % sets];
    size_t k = 0;
    while (k + 1 < ways && set[k] != line + 1) {
      ++k;
    }
    const bool had = set[k] == line + 1; // 0 is empty
    for (; k > 0; --k) {
      set[k] = set[k - 1];
    }
    set[0] = line + 1;
    return had;
  }

private:
  std::vector<std::array<uint64_t, ways>> m_lines = std::vector<std::array<uint64_t, ways>>(sets);
};

std::string outFile;
std::vector<std::unique_ptr<Block>> blocks;
bool inside = false; // of vpCountedFrames
unsigned int entries = 0, returns = 0;

Cache<128, 4> level1;  // 32 KiB of data
Cache<512, 16> level2; // 512 KiB, for this core alone
uint64_t missed1 = 0, missed2 = 0;

const Block *before = nullptr;
uint64_t history = 0;
std::array<uint8_t, 3072> taken =
    {}; // the size of the A53's pattern history (DDI 0500, 2.1.1); how it is indexed is not told
uint64_t conditions = 0, mispredicted = 0;

void predict(const Block &now)
{
  if (before && before->endsInCondition()) {
    uint8_t &counter = taken[((before->end() >> 2) ^ (history & 0xff)) % taken.size()];
    const bool jumped = now.address != before->end();
    ++conditions;
    mispredicted += (counter >= 2) != jumped;
    if (jumped && counter < 3) {
      ++counter;
    } else if (!jumped && counter > 0) {
      --counter;
    }
    history = history << 1 | jumped;
  }
  before = &now;
}

void onBlock(unsigned int, void *data)
{
  if (inside) {
    Block &block = *static_cast<Block *>(data);
    ++block.executed;
    predict(block);
  }
}

void onAccess(unsigned int, uint32_t, uint64_t address, void *)
{
  if (inside && !level1.has(address / 64)) {
    ++missed1;
    missed2 += !level2.has(address / 64);
  }
}

void onEntry(unsigned int, void *)
{
  inside = true;
  ++entries;
}

void onReturn(unsigned int, void *)
{
  inside = false;
  ++returns;
}

void onTranslated(uint64_t, qemu_plugin_tb *translated)
{
  blocks.push_back(std::make_unique<Block>());
  Block &block = *blocks.back();
  const size_t size = qemu_plugin_tb_n_insns(translated);
  qemu_plugin_register_vcpu_tb_exec_cb(translated, onBlock, QEMU_PLUGIN_CB_NO_REGS, &block);
  static uint64_t start = 0; // of vpCountedFrames
  for (size_t k = 0; k < size; ++k) {
    qemu_plugin_insn *instruction = qemu_plugin_tb_get_insn(translated, k);
    uint32_t code;
    std::memcpy(&code, qemu_plugin_insn_data(instruction), sizeof(code));
    block.code.push_back(code);
    const uint64_t address = qemu_plugin_insn_vaddr(instruction);
    block.address = k == 0 ? address : block.address;
    qemu_plugin_register_vcpu_mem_cb(instruction, onAccess, QEMU_PLUGIN_CB_NO_REGS, QEMU_PLUGIN_MEM_RW,
                                     nullptr);
    const char *symbol = qemu_plugin_insn_symbol(instruction);
    if (symbol && std::strncmp(symbol, "vpCountedFrames", 15) == 0) {
      start = start ? start : address; // it is called before anything else of it is seen
      if (address == start) {
        qemu_plugin_register_vcpu_insn_exec_cb(instruction, onEntry, QEMU_PLUGIN_CB_NO_REGS, nullptr);
      }
      if (code == returnInstruction) {
        qemu_plugin_register_vcpu_insn_exec_cb(instruction, onReturn, QEMU_PLUGIN_CB_NO_REGS, nullptr);
      }
    }
  }
}

// The first line: what was counted, then one line a block: how often, and its instructions in hexadecimal.
void onExit(uint64_t, void *)
{
  FILE *file = std::fopen(outFile.c_str(), "w");
  if (!file) {
    std::perror(outFile.c_str());
    return;
  }
  std::fprintf(file, "entries %u returns %u conditions %" PRIu64 " mispredicted %" PRIu64, entries, returns,
               conditions, mispredicted);
  std::fprintf(file, " missed1 %" PRIu64 " missed2 %" PRIu64 "\n", missed1, missed2);
  for (const std::unique_ptr<Block> &block : blocks) {
    if (block->executed > 0) {
      std::fprintf(file, "%" PRIu64, block->executed);
      for (const uint32_t code : block->code) {
        std::fprintf(file, " %08" PRIx32, code);
      }
      std::fprintf(file, "\n");
    }
  }
  std::fclose(file);
}
} // namespace

extern "C" {
__attribute__((visibility("default"))) extern const int qemu_plugin_version = 1;

__attribute__((visibility("default"))) int qemu_plugin_install(uint64_t plugin, const void *, int argc,
                                                               char **argv)
{
  for (int k = 0; k < argc; ++k) {
    if (std::strncmp(argv[k], "out=", 4) == 0) {
      outFile = argv[k] + 4;
    }
  }
  if (outFile.empty()) {
    std::fprintf(stderr, "libcountBlocks.so: out=FILE is missing\n");
    return 1;
  }
  qemu_plugin_register_vcpu_tb_trans_cb(plugin, onTranslated);
  qemu_plugin_register_atexit_cb(plugin, onExit, nullptr);
  return 0;
}
}
