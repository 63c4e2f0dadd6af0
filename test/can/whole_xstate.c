// For canrun: lets user-mode Linux up to 6.1 start on a processor with AMX. It writes its processes' floating-point registers with
// PTRACE_SETREGSET (NT_X86_XSTATE) from a buffer that ends with AVX-512's. The host's kernel takes the whole of what its processor has,
// or says EFAULT: "ptrace set fp regs failed, errno = 14". So the rest is what the process has already.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <elf.h>
#include <stdarg.h>
#include <string.h>
#include <sys/ptrace.h>
#include <sys/types.h>
#include <sys/uio.h>

typedef long (*Ptrace)(enum __ptrace_request, ...);

long ptrace(enum __ptrace_request request, ...) {
  va_list list;
  va_start(list, request);
  const pid_t process = va_arg(list, pid_t);
  void* const address = va_arg(list, void*);
  void* const data = va_arg(list, void*);
  va_end(list);
  const Ptrace next = (Ptrace)dlsym(RTLD_NEXT, "ptrace");
  if (request == PTRACE_SETREGSET && address == (void*)NT_X86_XSTATE) {
    static char state[1 << 16];
    struct iovec whole = {.iov_base = state, .iov_len = sizeof state};
    const struct iovec* const part = data;
    if (next(PTRACE_GETREGSET, process, address, &whole) == 0 && part->iov_len < whole.iov_len) {
      memcpy(state, part->iov_base, part->iov_len);
      return next(request, process, address, &whole);
    }
  }
  return next(request, process, address, data);
}
