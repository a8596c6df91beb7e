#!/usr/bin/env python3
"""Each file names the headers of the C++ library that it needs, itself or through headers of burr.

    scripts/checks/includes.py [ROOT]       ROOT: a checkout; default: this one

The builds for users precompile common headers, so the compiler no longer shows a missing #include. This check does: for every
`std::name` that it knows, one of the headers that provide the name by the standard must be among the #include lines of the file
or of the burr headers that it includes. What the headers of libstdc++ or of other libraries include by chance does not count.
"""
import pathlib
import re
import sys


PROVIDES = {
    "algorithm": "all_of any_of none_of for_each find find_if find_if_not count count_if copy copy_n copy_if fill fill_n generate remove_if"
                 " unique reverse rotate shuffle sort stable_sort partial_sort nth_element lower_bound upper_bound binary_search equal_range"
                 " merge min max minmax clamp min_element max_element minmax_element transform replace partition stable_partition"
                 " is_sorted mismatch set_difference includes next_permutation push_heap pop_heap make_heap",
    "array": "array to_array",
    "atomic": "atomic atomic_bool atomic_int atomic_flag atomic_thread_fence memory_order memory_order_relaxed memory_order_acquire"
              " memory_order_release memory_order_acq_rel memory_order_seq_cst",
    "bit": "countr_zero countl_zero popcount bit_width has_single_bit bit_ceil endian",
    "bitset": "bitset",
    "charconv": "from_chars to_chars",
    "cmath": "sqrt sin cos tan asin acos atan atan2 exp exp2 log log2 log10 log1p pow floor ceil round lround llround lrint lrintf trunc fmod hypot"
             " isfinite isnan isinf cbrt erf erfc copysign fma remainder tgamma lgamma sqrtf",
    "complex": "complex",
    "condition_variable": "condition_variable condition_variable_any",
    "deque": "deque",
    "exception": "exception_ptr current_exception rethrow_exception set_terminate",
    "filesystem": "filesystem",
    "fstream": "ifstream ofstream fstream",
    "functional": "function reference_wrapper ref cref hash less greater plus minus multiplies bind",
    "future": "future promise async packaged_task",
    "initializer_list": "initializer_list",
    "iomanip": "setw setprecision setfill put_time get_time",
    "iostream": "cout cerr cin clog",
    "iterator": "back_inserter inserter istreambuf_iterator istream_iterator ostream_iterator next prev advance distance make_move_iterator"
                " reverse_iterator ssize",
    "limits": "numeric_limits",
    "list": "list",
    "locale": "locale",
    "map": "map multimap",
    "memory": "unique_ptr shared_ptr weak_ptr make_unique make_shared enable_shared_from_this allocator addressof",
    "memory_resource": "pmr",
    "mutex": "mutex lock_guard unique_lock scoped_lock recursive_mutex once_flag call_once",
    "new": "bad_alloc nothrow launder align_val_t",
    "numbers": "numbers",
    "numeric": "accumulate iota inner_product partial_sum reduce gcd lcm midpoint",
    "optional": "optional nullopt nullopt_t",
    "queue": "queue priority_queue",
    "random": "mt19937 mt19937_64 uniform_real_distribution uniform_int_distribution normal_distribution bernoulli_distribution random_device"
              " minstd_rand discrete_distribution exponential_distribution seed_seq",
    "regex": "regex smatch regex_match regex_search regex_replace",
    "set": "set multiset",
    "shared_mutex": "shared_mutex shared_lock",
    "span": "span as_bytes",
    "sstream": "stringstream istringstream ostringstream",
    "stdexcept": "runtime_error logic_error invalid_argument out_of_range length_error",
    "stop_token": "stop_token stop_source",
    "string": "string to_string stoi stol stoll stod stof stoul stoull getline u8string wstring",
    "string_view": "string_view",
    "system_error": "error_code system_error system_category generic_category errc",
    "thread": "thread jthread this_thread",
    "tuple": "tuple tie make_tuple forward_as_tuple apply tuple_size",
    "type_traits": "is_same_v enable_if_t is_integral_v is_floating_point_v is_trivially_copyable_v is_signed_v is_unsigned_v decay_t"
                   " remove_reference_t remove_cvref_t conditional_t underlying_type_t is_enum_v is_convertible_v is_base_of_v true_type"
                   " false_type make_unsigned_t make_signed_t is_const_v remove_const_t is_arithmetic_v is_same is_invocable_v",
    "unordered_map": "unordered_map unordered_multimap",
    "unordered_set": "unordered_set",
    "utility": "pair make_pair exchange move forward swap declval in_place integer_sequence index_sequence make_index_sequence as_const",
    "variant": "variant visit get_if holds_alternative monostate",
    "vector": "vector",
    "chrono": "chrono",
    "cstring": "memcpy memset memcmp memmove strlen strcmp strncmp strerror strchr strstr",
    "cstdlib": "getenv exit abort malloc free strtod strtol strtoul strtoull strtoll system atexit _Exit",
    "cstdio": "FILE printf fprintf snprintf fopen fclose fputs puts fflush remove rename",
    "cstdint": "int8_t int16_t int32_t int64_t uint8_t uint16_t uint32_t uint64_t uintptr_t intptr_t",
    "cstddef": "size_t ptrdiff_t byte nullptr_t max_align_t",
    "csignal": "signal raise sig_atomic_t",
    "ctime": "time_t tm time strftime gmtime localtime mktime",
    "ostream": "ostream endl flush",
    "istream": "istream",
}
# what the standard promises of other headers, and names that several headers declare
ALSO = {
    "size_t": "cstdio cstring ctime cstdlib", "string": "sstream filesystem fstream", "string_view": "string filesystem",
    "hash": "string string_view memory optional variant thread", "move": "algorithm", "swap": "algorithm vector array string memory optional",
    "remove": "algorithm", "initializer_list": "vector string map set array utility algorithm", "tuple_size": "array utility",
    "pair": "map unordered_map", "make_pair": "map unordered_map", "allocator": "vector string",
    "next": "vector string map set array list deque span", "prev": "vector string map set array list deque span",
    "distance": "vector string map set array list deque span", "advance": "vector string map set array list deque span",
    "ssize": "vector string map set array list deque span", "ostream": "iostream sstream fstream", "istream": "iostream sstream fstream",
    "endl": "iostream", "flush": "iostream", "error_code": "filesystem mutex thread", "errc": "charconv", "byte": "span",
    "nullopt": "", "getline": "sstream fstream iostream", "get": "", "time_t": "chrono", "locale": "iostream sstream fstream",
    "ptrdiff_t": "iterator vector", "move_only_function": "", "runtime_error": "", "chrono": "thread", "as_const": "algorithm",
    "abort": "", "exchange": "", "forward": "algorithm", "generic_category": "filesystem", "system_category": "filesystem",
    "memory_order": "", "this_thread": "",
}
# std::size_t and the like are typedefs that nearly every header declares; a file that has one of the containers has them
LENIENT = {"size_t", "ptrdiff_t", "int8_t", "int16_t", "int32_t", "int64_t", "uint8_t", "uint16_t", "uint32_t", "uint64_t"}


def code_of(text):
    """The text without comments and without the content of string literals."""
    text = re.sub(r'R"(\w*)\((?:.|\n)*?\)\1"', '""', text)
    return re.sub(r'//[^\n]*|/\*(?:.|\n)*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'',
                  lambda found: " " if found.group(0).startswith("/") else '""', text)


class Files:
    def __init__(self, root):
        self.known = {}
        self.folders = [root / "src", root / "apps" / "burr", root]

    def of(self, path):
        """(headers of C++ named by the file, files of burr named by it, code)"""
        if path not in self.known:
            text = path.read_text(errors="replace")
            own = [next((folder / name for folder in (path.parent, *self.folders) if (folder / name).is_file()), None)
                   for name in re.findall(r'^\s*#\s*include\s+"([^"]+)"', text, re.M)]
            self.known[path] = (set(re.findall(r"^\s*#\s*include\s+<(\w+)>", text, re.M)), [file for file in own if file], code_of(text))
        return self.known[path]

    def closure(self, path):
        seen, todo, headers = set(), [path], set()
        while todo:
            file = todo.pop()
            if file in seen:
                continue
            seen.add(file)
            named, own, _ = self.of(file)
            headers |= named
            todo += own
        return headers


def main():
    homes = {}
    for header, names in PROVIDES.items():
        for name in names.split():
            homes.setdefault(name, set()).add(header)
    for name, headers in ALSO.items():
        homes.setdefault(name, set()).update(headers.split())
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parents[2]).resolve()
    files, faults, looked = Files(root), [], 0
    for folder in ("src/burr", "apps/burr", "scenes"):
        for path in sorted((root / folder).rglob("*")):
            if path.suffix not in (".h", ".cpp"):
                continue
            looked += 1
            headers = files.closure(path)
            missing = {}
            for name in set(re.findall(r"\bstd::(\w+)", files.of(path)[2])):
                if name in homes and homes[name] and not homes[name] & headers and not (name in LENIENT and headers):
                    missing.setdefault(min(homes[name], key=lambda home: (name not in PROVIDES.get(home, "").split(), home)), []).append(name)
            for header, names in sorted(missing.items()):
                faults.append(f"{path.relative_to(root)}: std::{', std::'.join(sorted(names))}: #include <{header}> is missing")
    if looked == 0:
        print("includes.py: there is no file to look at", file=sys.stderr)
        return 2
    print("\n".join(faults) if faults else f"includes: {looked} files name the headers that they need")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
