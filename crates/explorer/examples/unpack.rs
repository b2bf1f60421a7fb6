//! The module that unpacks the module of the page: LZMA makes that a third smaller than the
//! browser's own gzip does.
//!
//! An example, so that it is a module of its own, which the library's exports are no part of. The
//! page writes a file of `xz --format=lzma` into [`input`], calls [`unpack`], and reads what it
//! returns, as long as nothing else is called.

use std::cell::RefCell;
use std::io::Read;

use lzma_rust2::LzmaReader;

thread_local! {
    /// What is packed, and what it was.
    static BYTES: RefCell<[Vec<u8>; 2]> = RefCell::default();
}

/// Room for a file of `length` bytes, which the page writes there.
#[allow(unsafe_code, reason = "the name of an export")]
#[unsafe(no_mangle)]
pub extern "C" fn input(length: usize) -> *mut u8 {
    BYTES.with_borrow_mut(|[packed, _]| {
        *packed = vec![0; length];
        packed.as_mut_ptr()
    })
}

/// Unpacks the file in [`input`] into `size` bytes; returns them, or null if it has not so many.
#[allow(unsafe_code, reason = "the name of an export")]
#[unsafe(no_mangle)]
pub extern "C" fn unpack(size: usize) -> *const u8 {
    BYTES.with_borrow_mut(|[packed, unpacked]| {
        *unpacked = vec![0; size];
        let read = LzmaReader::new_mem_limit(packed.as_slice(), u32::MAX, None)
            .and_then(|mut reader| reader.read_exact(unpacked));
        read.map_or(std::ptr::null(), |()| unpacked.as_ptr())
    })
}
