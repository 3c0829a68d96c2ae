//! Builds the C program if there is a C compiler; without one, the table has no row for it.

fn main() {
    println!("cargo:rerun-if-changed=c");
    println!("cargo:rustc-check-cfg=cfg(has_c)");
    let built = cc::Build::new()
        .file("c/imm.c")
        .opt_level(3)
        .std("c11")
        .try_compile("imm");
    match built {
        Ok(()) => println!("cargo:rustc-cfg=has_c"),
        Err(error) => println!("cargo:warning=no row for C: {error}"),
    }
}
