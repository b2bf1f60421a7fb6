declare module "*.slip" {
  const text: string;
  export default text;
}
