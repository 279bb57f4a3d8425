// GELU in its erf form: x/2 (1 + erf(x / sqrt 2)), erf by Abramowitz and Stegun 7.1.26.
// |error of erf| below 1.5e-7. Twin: engine/reference/gelu.hpp.
float gelu(float x) {
  float z = abs(x) * 0.70710678118654752;
  float t = 1.0 / (1.0 + 0.3275911 * z);
  float poly =
      t * (0.254829592 +
           t * (-0.284496736 + t * (1.421413741 + t * (-1.453152027 + t * 1.061405429))));
  float tail = poly * exp(-z * z);  // 1 - erf(|x| / sqrt 2)
  return 0.5 * (x + abs(x) * (1.0 - tail));
}
