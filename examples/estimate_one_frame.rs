// One frame from Rust through the C interface, <flowdlo/flowdlo.h>, by declarations written out by hand:
//   rustc -O estimate_one_frame.rs -L PREFIX/lib -l flowdlo && ./estimate_one_frame FRAME_FOLDER
use std::ffi::{c_char, c_void, CStr, CString};
use std::mem::{size_of, MaybeUninit};
use std::ptr::null_mut;

#[repr(C)]
struct Image {
    data: *const c_void,
    row_bytes: isize,
    pixel_bytes: isize,
    pixel: i32,
    reserved: i32,
}

#[repr(C)]
struct Frame {
    struct_size: usize,
    images: [Image; 3], // depth, mask, color
    depth_scale_m: f64,
    size: [i32; 2], // width, height
    intrinsics: [f32; 4], // fx, fy, cx, cy
    region: [i32; 4],
}

#[repr(C)]
struct Estimate {
    struct_size: usize,
    nodes: [[f32; 3]; 64], // metres, camera frame, end to end
    sigma_m: [f32; 64],
    support: [u8; 64],
    confidence: f32,
    others: [u8; 156], // the rest of flowdlo_estimate
}

extern "C" {
    fn flowdlo_last_error() -> *const c_char;
    fn flowdlo_frame_init(frame: *mut Frame, size: usize) -> i32;
    fn flowdlo_frame_folder_load(path: *const c_char, folder: *mut *mut c_void) -> i32;
    fn flowdlo_frame_folder_frame(folder: *const c_void, frame: *mut Frame) -> i32;
    fn flowdlo_frame_folder_destroy(folder: *mut c_void);
    fn flowdlo_estimator_create(config: *const c_void, estimator: *mut *mut c_void) -> i32;
    fn flowdlo_estimate_init(estimate: *mut Estimate, size: usize) -> i32;
    fn flowdlo_estimator_estimate(
        estimator: *mut c_void,
        frame: *const Frame,
        estimate: *mut Estimate,
    ) -> i32;
    fn flowdlo_estimator_destroy(estimator: *mut c_void);
}

fn check(status: i32) -> Result<(), String> {
    if status == 0 {
        return Ok(());
    }
    Err(unsafe { CStr::from_ptr(flowdlo_last_error()) }.to_string_lossy().into_owned())
}

fn main() -> Result<(), String> {
    let path = std::env::args().nth(1).unwrap_or_else(|| ".".into());
    let path = CString::new(path).map_err(|fault| fault.to_string())?;
    let (mut folder, mut estimator) = (null_mut(), null_mut());
    let mut frame = MaybeUninit::<Frame>::uninit();
    let mut estimate = MaybeUninit::<Estimate>::uninit();
    unsafe {
        check(flowdlo_frame_folder_load(path.as_ptr(), &mut folder))?;
        check(flowdlo_frame_init(frame.as_mut_ptr(), size_of::<Frame>()))?;
        check(flowdlo_frame_folder_frame(folder, frame.as_mut_ptr()))?;
        check(flowdlo_estimator_create(std::ptr::null(), &mut estimator))?;
        check(flowdlo_estimate_init(estimate.as_mut_ptr(), size_of::<Estimate>()))?;
        check(flowdlo_estimator_estimate(estimator, frame.as_ptr(), estimate.as_mut_ptr()))?;
        let estimate = estimate.assume_init();
        for [x, y, z] in estimate.nodes {
            println!("{x} {y} {z}");
        }
        eprintln!("confidence {}", estimate.confidence);
        flowdlo_estimator_destroy(estimator);
        flowdlo_frame_folder_destroy(folder);
    }
    Ok(())
}
