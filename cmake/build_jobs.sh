#!/bin/sh
# Prints how many compilers to run at once: one per core, but no more than one per 2 GB of memory that is free, as a
# file that instantiates PCL's templates can take that much. PCL_FFT_GROUND_JOBS overrides it.
set -eu

kilobytes_per_job=2000000

# free_kilobytes: what the machine has available, or the container's limit where that is less.
free_kilobytes() {
  free=$(awk '/^MemAvailable:/ { print $2 }' /proc/meminfo 2>/dev/null || true)
  limit=$(cat /sys/fs/cgroup/memory.max 2>/dev/null || echo max)
  if [ "$limit" != max ] && [ "$((limit / 1024))" -lt "${free:-0}" ]; then
    free=$((limit / 1024))
  fi
  echo "${free:-$kilobytes_per_job}"
}

jobs=${PCL_FFT_GROUND_JOBS:-}
if [ -z "$jobs" ]; then
  jobs=$(nproc 2>/dev/null || echo 1)
  by_memory=$(($(free_kilobytes) / kilobytes_per_job))
  [ "$by_memory" -ge "$jobs" ] || jobs=$by_memory
  [ "$jobs" -ge 1 ] || jobs=1
fi
echo "$jobs"
