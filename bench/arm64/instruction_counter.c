/* A plugin of QEMU's user mode that counts the instructions of a program by the function that they
 * stand in: a line of count and name each to the file of the option out=, the sum of all last.
 * Exact for a program with one thread. Declared here is what it uses of QEMU's plugin interface,
 * version 1, since Debian ships no header. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef uint64_t plugin_id;
struct block; /* translated at once: instructions up to a jump */
struct instruction;
size_t qemu_plugin_tb_n_insns(const struct block*);
struct instruction* qemu_plugin_tb_get_insn(const struct block*, size_t index);
const char* qemu_plugin_insn_symbol(const struct instruction*);
void qemu_plugin_register_vcpu_tb_trans_cb(plugin_id, void (*)(plugin_id, struct block*));
void qemu_plugin_register_vcpu_tb_exec_inline(struct block*, int operation, void* at, uint64_t by);
void qemu_plugin_register_atexit_cb(plugin_id, void (*)(plugin_id, void*), void*);

int qemu_plugin_version = 1;

enum { ADD_U64 = 0 };

struct function {
  struct function* next;
  uint64_t count;
  char name[];
};

static struct function* functions;
static FILE* out;

static struct function* function_named(const char* name) {
  struct function* at = functions;
  while (at != NULL && strcmp(at->name, name) != 0) at = at->next;
  if (at != NULL) return at;
  at = calloc(1, sizeof *at + strlen(name) + 1);
  if (at == NULL) abort();
  strcpy(at->name, name);
  at->next = functions;
  functions = at;
  return at;
}

static void count_block(plugin_id id, struct block* block) {
  (void)id;
  const char* name = qemu_plugin_insn_symbol(qemu_plugin_tb_get_insn(block, 0));
  struct function* const function = function_named(name != NULL ? name : "(of a shared library)");
  qemu_plugin_register_vcpu_tb_exec_inline(block, ADD_U64, &function->count,
                                           qemu_plugin_tb_n_insns(block));
}

static void report(plugin_id id, void* unused) {
  (void)id;
  (void)unused;
  uint64_t sum = 0;
  for (const struct function* at = functions; at != NULL; at = at->next) {
    if (at->count > 0) fprintf(out, "%llu %s\n", (unsigned long long)at->count, at->name);
    sum += at->count;
  }
  fprintf(out, "%llu all\n", (unsigned long long)sum);
  fclose(out);
}

int qemu_plugin_install(plugin_id id, const void* info, int argc, char** argv) {
  (void)info;
  for (int i = 0; i < argc; ++i) {
    if (strncmp(argv[i], "out=", 4) == 0) out = fopen(argv[i] + 4, "w");
  }
  if (out == NULL) {
    fprintf(stderr, "instruction_counter: expected out=FILE, a file that can be written\n");
    return 1;
  }
  qemu_plugin_register_vcpu_tb_trans_cb(id, count_block);
  qemu_plugin_register_atexit_cb(id, report, NULL);
  return 0;
}
