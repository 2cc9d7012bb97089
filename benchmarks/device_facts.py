"""What is known of the device's kernel: by the driver, or without a device from what is compiled for one.

python -m benchmarks.device_facts     as compiled for compute capability 9.0, of 2022
"""

from __future__ import annotations

import ctypes
import struct
import tempfile
import time
from collections.abc import Callable, Iterator
from statistics import median
from typing import Any

from arm2d.device.opening import CHECK, Device, open_device

ROUNDS = 5
ARCHITECTURE = 90
REGISTERS_OF_A_MULTIPROCESSOR = 65536
# Kinds of entries in the section .nv.info of a program for CUDA, all of (symbol, number).
REGISTERS, STACK = 0x2F, 0x12
# CUfunction_attribute of the driver's interface.
ATTRIBUTES = {"registers a thread": 4, "local memory a thread [bytes]": 3}


def facts_of(device: Device) -> Iterator[tuple[str, str]]:
    """Registers, local memory and how many threads of the kernel the device can hold."""
    import warp

    from arm2d.device import loop
    from arm2d.device.memory import BLOCK

    yield "Warp", warp.__version__
    if device.where == "cpu":
        return
    found = warp.get_device(device.where)
    yield "compute capability", f"{found.arch / 10:.1f}"
    yield "memory", f"{found.total_memory / 2**30:.0f} GiB"
    yield "multiprocessors", str(found.sm_count)
    try:
        yield from _told_by_driver(loop.run_trials, found, BLOCK)
    except (OSError, AttributeError, RuntimeError, TypeError) as error:
        yield "occupancy", f"not told ({error})"


def _told_by_driver(kernel: Any, device: Any, block: int) -> Iterator[tuple[str, str]]:
    began = time.monotonic()
    function = ctypes.c_void_p(kernel.module.load(device, block).get_kernel_hooks(kernel).forward)
    yield "compiled, or read back, in", f"{time.monotonic() - began:.1f} s"
    driver, value = ctypes.CDLL("libcuda.so.1"), ctypes.c_int()
    for name, attribute in ATTRIBUTES.items():
        if driver.cuFuncGetAttribute(ctypes.byref(value), attribute, function):
            raise RuntimeError(f"cuFuncGetAttribute fails for {name}")
        yield name, str(value.value)
    if driver.cuOccupancyMaxActiveBlocksPerMultiprocessor(
        ctypes.byref(value), function, block, ctypes.c_size_t(0)
    ):
        raise RuntimeError("cuOccupancyMaxActiveBlocksPerMultiprocessor fails")
    yield "threads a multiprocessor holds", f"{value.value * block}, in blocks of {block}"


def kernel_seconds(device: Device, work: Callable[[], Any]) -> tuple[float, str]:
    """Time of some work [s], the median of a few rounds, and in words how much of it was kernels."""
    import warp

    whole, alone = [], []
    for _ in range(ROUNDS):
        on_device = device.where != "cpu"
        if on_device:
            warp.timing_begin(cuda_filter=warp.TIMING_KERNEL)
        began = time.perf_counter()
        work()
        whole.append(time.perf_counter() - began)
        if on_device:
            alone.append(sum(each.elapsed for each in warp.timing_end()))
    told = f"of it {median(alone):.1f} ms in kernels" if alone else "kernels not timed"
    return median(whole), told


def main() -> None:
    """Compile and print; takes no device."""
    open_device(CHECK)
    import warp

    from arm2d.device import loop

    with tempfile.TemporaryDirectory() as folder:
        (path,) = warp.compile_aot_module(loop, arch=ARCHITECTURE, module_dir=folder, use_ptx=False)
        program = path.read_bytes()
    registers, stack = (max(_numbers(program, kind)) for kind in (REGISTERS, STACK))
    print(f"{registers} registers a thread, {stack} bytes of local memory")
    # Registers are given to the 32 threads of a warp in blocks of 256.
    per_warp = -(-32 * registers // 256) * 256
    print(f"{REGISTERS_OF_A_MULTIPROCESSOR // per_warp * 32} threads on a multiprocessor at a time")


def _numbers(program: bytes, kind: int) -> list[int]:
    """The numbers of one kind in the sections .nv.info of an ELF file."""
    (start,) = struct.unpack_from("<Q", program, 40)
    size, n, names = struct.unpack_from("<HHH", program, 58)
    sections = [struct.unpack_from("<IIQQQQ", program, start + size * i) for i in range(n)]
    found = []
    for name, _, _, _, offset, length in sections:
        at = sections[names][4] + name
        if program[at : program.index(0, at)] != b".nv.info":
            continue
        entry = offset
        while entry < offset + length:
            long = program[entry] == 4  # followed by as many bytes as it says
            (n_bytes,) = struct.unpack_from("<H", program, entry + 2) if long else (0,)
            if program[entry + 1] == kind and n_bytes == 8:
                found.append(struct.unpack_from("<II", program, entry + 4)[1])
            entry += 4 + n_bytes
    return found


if __name__ == "__main__":
    main()
