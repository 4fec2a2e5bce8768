from typing import Any, Optional, Sequence, Union

import numpy as np
import numpy.typing as npt

__version__: str

class Surface:
    @property
    def height(self) -> npt.NDArray[np.float64]: ...
    @property
    def uncertainty(self) -> npt.NDArray[np.float64]: ...
    @property
    def supported(self) -> npt.NDArray[np.bool_]: ...
    @property
    def cell_size(self) -> float: ...
    @property
    def lower_corner(self) -> npt.NDArray[np.float64]: ...
    @property
    def frame_from_input(self) -> npt.NDArray[np.float64]: ...

class Segmentation:
    @property
    def labels(self) -> npt.NDArray[np.int32]: ...
    @property
    def height(self) -> npt.NDArray[np.float64]: ...
    @property
    def p_ground(self) -> npt.NDArray[np.float32]: ...
    @property
    def segments(self) -> npt.NDArray[np.int32]: ...
    @property
    def surface(self) -> Surface: ...
    @property
    def report(self) -> dict[str, Any]: ...

def segment(
    xyz: Union[npt.NDArray[np.float32], npt.NDArray[np.float64]],
    max_object_size: Optional[float] = ...,
    *,
    method: str = ...,
    clusters: Optional[str] = ...,
    leaf_size: Optional[float] = ...,
    min_object_size: Optional[float] = ...,
    min_cluster_size: int = ...,
    threads: Optional[int] = ...,
    sensor: Optional[Sequence[float]] = ...,
    cell_size: Optional[float] = ...,
    height_tolerance: Optional[float] = ...,
    up_direction: Optional[Sequence[float]] = ...,
    up_estimation: Optional[str] = ...,
    yaw: Optional[str] = ...,
    relative_max_object_size: Optional[float] = ...,
    filter_order: Optional[int] = ...,
    passband_ripple: Optional[float] = ...,
    max_slope: Optional[float] = ...,
    finest_wavelength: Optional[float] = ...,
    cell_statistic: Optional[str] = ...,
    cutoff_frequency: Optional[float] = ...,
    peak_window: Optional[int] = ...,
    peak_threshold: Optional[float] = ...,
    distance_threshold: Optional[float] = ...,
    max_iterations: Optional[int] = ...,
    probability: Optional[float] = ...,
    optimize_coefficients: Optional[bool] = ...,
    plane_seed: Optional[int] = ...,
    voxel_height: Optional[float] = ...,
    object_height: Optional[float] = ...,
    step_height: Optional[float] = ...,
    smoothness: Optional[float] = ...,
) -> Segmentation: ...

class Alignment:
    @property
    def accepted(self) -> bool: ...
    @property
    def refusal(self) -> str: ...
    @property
    def reference_from_moving(self) -> npt.NDArray[np.float64]: ...
    @property
    def covariance(self) -> npt.NDArray[np.float64]: ...
    @property
    def origin(self) -> npt.NDArray[np.float64]: ...
    @property
    def score(self) -> float: ...
    @property
    def overlap(self) -> float: ...
    @property
    def method(self) -> str: ...

def align(
    reference: Union[npt.NDArray[np.float32], npt.NDArray[np.float64]],
    moving: Union[npt.NDArray[np.float32], npt.NDArray[np.float64]],
    guess: Optional[npt.ArrayLike] = ...,
    max_object_size: Optional[float] = ...,
    sensor: Optional[Union[Sequence[float], Sequence[Sequence[float]]]] = ...,
    *,
    search: Optional[str] = ...,
    matching: Optional[str] = ...,
    fallback: Optional[str] = ...,
    relief: Optional[str] = ...,
    max_shift: Optional[float] = ...,
    max_turn: Optional[float] = ...,
    min_matches: Optional[int] = ...,
    min_score: Optional[float] = ...,
    max_sigma: Optional[float] = ...,
    min_extent: Optional[float] = ...,
    min_voxels: Optional[int] = ...,
    max_segments: Optional[int] = ...,
    voxel_size: Optional[float] = ...,
    threads: Optional[int] = ...,
    cell_size: Optional[float] = ...,
    height_tolerance: Optional[float] = ...,
    up_direction: Optional[Sequence[float]] = ...,
    up_estimation: Optional[str] = ...,
    yaw: Optional[str] = ...,
    relative_max_object_size: Optional[float] = ...,
    filter_order: Optional[int] = ...,
    passband_ripple: Optional[float] = ...,
    max_slope: Optional[float] = ...,
    finest_wavelength: Optional[float] = ...,
    cell_statistic: Optional[str] = ...,
) -> Alignment: ...
