// All that a fragment reads, as variables that a proof sets.
#import <types>
#import "lighting/frame.wgsl"
#import "lighting/lights.wgsl"
#import "surface/visible_point.wgsl"
