/* A plugin for QEMU that counts instructions; the counts are exact and the same in every run.
 *
 * mark=ADDRESS  whenever this instruction is about to run, print how many ran since the start: "mark 1234"
 * list=ADDRESS  the same, then every instruction that ran since the last list, and how often:
 *               "ran ADDRESS TIMES", the address in hexadecimal; one may come several times
 *
 * Blocks of code are counted, not single instructions: they run from their first to their last one, and both
 * addresses are to be the entries of functions, where blocks begin. API is the plugin interface that QEMU speaks:
 * 1 up to QEMU 8, 2 since. What is used of it is declared here, as not every distribution has the header. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct translation;
struct instruction;
size_t qemu_plugin_tb_n_insns(const struct translation *);
struct instruction *qemu_plugin_tb_get_insn(const struct translation *, size_t);
uint64_t qemu_plugin_insn_vaddr(const struct instruction *);
typedef void executed(unsigned processor, void *data);
void qemu_plugin_register_vcpu_tb_exec_cb(struct translation *, executed *, int registers, void *data);
void qemu_plugin_register_vcpu_insn_exec_cb(struct instruction *, executed *, int registers, void *data);
void qemu_plugin_register_vcpu_tb_trans_cb(uint64_t id, void (*)(uint64_t id, struct translation *));

int qemu_plugin_version = API;

struct block {
    struct block *next;
    uint64_t runs;
    size_t length;
    uint64_t address[];
};

static struct block *blocks;
static uint64_t instructions, mark, list;

static void on_block(unsigned processor, void *data) {
    struct block *block = data;
    block->runs++;
    instructions += block->length;
}

static void on_mark(unsigned processor, void *data) {
    fprintf(stderr, "mark %" PRIu64 "\n", instructions);
}

static void on_list(unsigned processor, void *data) {
    on_mark(processor, data);
    for (struct block *block = blocks; block; block = block->next) {
        for (size_t i = 0; block->runs && i < block->length; i++)
            fprintf(stderr, "ran %" PRIx64 " %" PRIu64 "\n", block->address[i], block->runs);
        block->runs = 0;
    }
}

static void on_translation(uint64_t id, struct translation *translation) {
    size_t length = qemu_plugin_tb_n_insns(translation);
    struct block *block = malloc(sizeof *block + length * sizeof block->address[0]);
    if (!block)
        abort();
    *block = (struct block){.next = blocks, .length = length};
    blocks = block;
    for (size_t i = 0; i < length; i++) {
        struct instruction *instruction = qemu_plugin_tb_get_insn(translation, i);
        uint64_t address = block->address[i] = qemu_plugin_insn_vaddr(instruction);
        if (address == mark || address == list)
            qemu_plugin_register_vcpu_insn_exec_cb(instruction, address == mark ? on_mark : on_list, 0, NULL);
    }
    qemu_plugin_register_vcpu_tb_exec_cb(translation, on_block, 0, block);
}

__attribute__((visibility("default"))) int qemu_plugin_install(uint64_t id, const void *info, int count, char **arguments) {
    for (int i = 0; i < count; i++) {
        if (!strncmp(arguments[i], "mark=", 5))
            mark = strtoull(arguments[i] + 5, NULL, 16);
        if (!strncmp(arguments[i], "list=", 5))
            list = strtoull(arguments[i] + 5, NULL, 16);
    }
    qemu_plugin_register_vcpu_tb_trans_cb(id, on_translation);
    return 0;
}
