//! Where the library itself lies: beside it, in an unpacked FMU, are its resources.

use std::path::PathBuf;

/// The folder `resources` of the FMU that this library was loaded from, if it was: `binaries/<platform>/moorline.*` and `resources` lie in one
/// folder.
pub fn resources() -> Option<PathBuf> {
    let platform = library()?.parent()?.to_owned();
    let binaries = platform.parent()?;
    binaries.ends_with("binaries").then(|| binaries.parent().map(|fmu| fmu.join("resources"))).flatten()
}

/// The file that this code was loaded from.
#[cfg(unix)]
pub fn library() -> Option<PathBuf> {
    use std::os::unix::ffi::OsStrExt;
    let mut info = libc::Dl_info {
        dli_fname: std::ptr::null(),
        dli_fbase: std::ptr::null_mut(),
        dli_sname: std::ptr::null(),
        dli_saddr: std::ptr::null_mut(),
    };
    // SAFETY: the address of a function of this library, and a place for what is known of it.
    let found = unsafe { libc::dladdr(library as *const libc::c_void, &raw mut info) } != 0 && !info.dli_fname.is_null();
    // SAFETY: the loader's own name of the file, zero-terminated, which lives as long as the library is loaded.
    found.then(|| PathBuf::from(std::ffi::OsStr::from_bytes(unsafe { std::ffi::CStr::from_ptr(info.dli_fname) }.to_bytes())))
}

/// The file that this code was loaded from.
#[cfg(windows)]
pub fn library() -> Option<PathBuf> {
    use std::ffi::{OsString, c_void};
    use std::os::windows::ffi::OsStringExt;
    #[link(name = "kernel32")]
    unsafe extern "system" {
        fn GetModuleHandleExW(flags: u32, address: *const c_void, module: *mut *mut c_void) -> i32;
        fn GetModuleFileNameW(module: *mut c_void, name: *mut u16, size: u32) -> u32;
    }
    /// By an address in it, and without counting it as used once more.
    const BY_ADDRESS: u32 = 4 | 2;
    let (mut module, mut name) = (std::ptr::null_mut(), vec![0_u16; 32_768]);
    // SAFETY: the address of a function of this library, and a place for its handle.
    if unsafe { GetModuleHandleExW(BY_ADDRESS, library as *const c_void, &raw mut module) } == 0 {
        return None;
    }
    // SAFETY: the handle just found, and a buffer of the size that is said.
    let length = unsafe { GetModuleFileNameW(module, name.as_mut_ptr(), name.len() as u32) } as usize;
    (length > 0 && length < name.len()).then(|| PathBuf::from(OsString::from_wide(&name[..length])))
}

/// The file that this code was loaded from: unknown.
#[cfg(not(any(unix, windows)))]
pub fn library() -> Option<PathBuf> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    /// In a test the code lies in the test program, which is no FMU.
    #[cfg(unix)]
    #[test]
    fn the_library_knows_its_file() {
        let found = library().unwrap();
        let program = std::env::current_exe().unwrap();
        assert_eq!(found.file_name(), program.file_name());
        assert_eq!(resources(), None);
    }
}
